// SPDX-License-Identifier: MIT
// Links only scarp::core, which must fail: render() is in scarp::scarp.
#include "scarp/scarp.h"

int main() { scarp::render(scarp::combine({}), "outside.png"); }
