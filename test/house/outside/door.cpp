// SPDX-License-Identifier: MIT
// Links scarp::core alone, which must fail: render() is in scarp::scarp.
#include "scarp/scarp.h"

int main() { scarp::render(scarp::combine({}), "outside.png"); }
