// The module `bonemill._bonemill`: the very tick of a session, for Python. The package around it, with its
// docstrings and types, lies in bonemill/.
#include <pybind11/pybind11.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include "common/base/user_error.h"
#include "common/cli/version.h"
#include "haptic_server/apps/python/runs.h"

PYBIND11_MODULE(_bonemill, module) {
    using namespace bonemill::python;
    // A module says nothing on stdout; what must be known is an exception or Run.warnings.
    if (!spdlog::get("bonemill")) spdlog::set_default_logger(spdlog::stderr_logger_mt("bonemill"));
    spdlog::set_level(spdlog::level::err);
    pybind11::register_exception<bonemill::UserError>(module, "Error", PyExc_ValueError);
    module.attr("__version__") = bonemill::versionText();
    defineResults(module);
    defineRuns(module);
    defineRecordings(module);
}
