// SPDX-License-Identifier: MIT
// The extension module pyscarp._core: what the Python code of the package builds on.
#include <pybind11/pybind11.h>

#include <memory>

#include "python/bind/bind.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"

namespace scarp::python {
namespace {

namespace py = pybind11;

std::unique_ptr<ThreadLimit> thread_limit;

// The exceptions are members of the package, not of this module.
PyObject* error_type = nullptr;
PyObject* interrupted_type = nullptr;

void add_errors(py::module_& module) {
  error_type =
      PyErr_NewExceptionWithDoc("pyscarp.Error", "Error of the library: one line, SUBJECT: what is wrong (what to do).",
                                PyExc_ValueError, nullptr);
  interrupted_type =
      PyErr_NewExceptionWithDoc("pyscarp.Interrupted", "A progress callback returned False.", error_type, nullptr);
  module.attr("Error") = py::handle(error_type);
  module.attr("Interrupted") = py::handle(interrupted_type);
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Interrupted& error) {
      PyErr_SetString(interrupted_type, error.what());
    } catch (const Error& error) {
      PyErr_SetString(error_type, error.what());
    }
  });
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  module.doc() = "The part of pyscarp in C++. Use the package instead.";
  module.attr("__version__") = SCARP_PYTHON_VERSION;
#ifdef SCARP_PYTHON_FILES
  module.attr("HAS_FILES") = true;
#else
  module.attr("HAS_FILES") = false;
#endif
#ifdef SCARP_ERFA
  module.attr("HAS_SUN") = true;
#else
  module.attr("HAS_SUN") = false;
#endif
  add_errors(module);
  module.def(
      "set_threads",
      [](int threads) {
        if (threads < 0) throw Error("threads: below 0 (expected a number of threads, or 0 for all)");
        thread_limit.reset();
        if (threads != 0) thread_limit = std::make_unique<ThreadLimit>(threads);
      },
      py::arg("threads"), "Limits the threads of all calls that start afterwards; 0: all. Raises Error below 0.");
  py::class_<SceneObject> base(module, "SceneBase");
  bind_queries(module, base);
  bind_terrain(module);
  bind_fans(module);
  bind_sight(module);
  bind_sun(module);
  bind_voxels(module);
  bind_scene(module);
  bind_picture(module);
#ifdef SCARP_PYTHON_FILES
  bind_crs(module);
#endif
}

}  // namespace scarp::python
