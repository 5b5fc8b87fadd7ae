// SPDX-License-Identifier: MIT
// Interpreter for the program of a terrain function over doubles or Taylor models, either with derivatives or without.
#pragma once

#include "scarp/field/function_jet.h"
#include "scarp/field/function_numbers.h"
#include "scarp/field/function_program.h"
#include "scarp/field/function_taylor.h"

namespace scarp::function {

inline void set_constant(double& out, double k) { out = k; }
template <std::size_t N>
void set_constant(Taylor<N>& out, double k) {
  out = from_constant<N>(k);
}
template <class T, std::size_t M>
void set_constant(Jet<T, M>& out, double k) {
  out = {};
  set_constant(out.v, k);
}

template <class T>
T run(const FunctionProgram& program, const T& x, const T& y) {
  T r[kFunctionRegisters];
  r[0] = x, r[1] = y;
  for (const FunctionInstruction& in : program.code) {
    const T &a = r[in.a], &b = r[in.b];
    T& out = r[in.out];
    switch (in.op) {
      case FunctionOp::constant:
        set_constant(out, in.k0);
        break;
      case FunctionOp::combine:
        out = combine(in.k0, a, in.k1, b, in.k2);
        break;
      case FunctionOp::turn: {
        const T turned = turned_place(in.k0, a, -in.k1, b);
        r[in.out_x] = turned_place(in.k1, a, in.k0, b);
        r[in.out] = turned;
        break;
      }
      case FunctionOp::multiply:
        out = multiply(a, b);
        break;
      case FunctionOp::square:
        out = square(a);
        break;
      case FunctionOp::absolute:
        out = absolute(a);
        break;
      case FunctionOp::clamp:
        out = clamp(a, in.k0, in.k1);
        break;
      case FunctionOp::sine:
        out = sine(a);
        break;
      case FunctionOp::minimum:
        out = minimum(a, b);
        break;
      case FunctionOp::maximum:
        out = maximum(a, b);
        break;
      case FunctionOp::smooth_minimum:
        out = smooth_minimum(a, b, in.k0);
        break;
      case FunctionOp::reciprocal:
        out = reciprocal(a);
        break;
      case FunctionOp::noise:
        out = noise_value(in, a, b);
        break;
      case FunctionOp::noise_slope:
        noise_slope(in, a, b, out, r[in.out_x], r[in.out_y]);
        break;
      case FunctionOp::terrace:
        out = terrace(a, in.k0, in.k1);
        break;
      case FunctionOp::radial:
        out = radial(a, b, in);
        break;
    }
  }
  return r[program.result];
}

}  // namespace scarp::function
