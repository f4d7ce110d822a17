// SPDX-License-Identifier: Apache-2.0
/// Long work: on a thread of its own, while the caller's thread, without the interpreter's lock, waits, looks for
/// signals, and tells the progress.
#pragma once

#include "arguments.h"

#include <vmlight/stage/make_options.h>

#include <pybind11/pybind11.h>

#include <functional>
#include <string>
#include <vector>

namespace vmlight::python {

/// Threads and progress, which every function takes.
struct WorkOptions
{
    int threads = 0;
    py::object progress = py::none();
    /// How many frames of Python up the caller is, whom warnings name: 1 is who calls the module.
    int warning_level = 1;
};

/// The arguments of WorkOptions, and their values in `keywords`. Throws TypeError and ValueError as set_params().
std::vector<Argument> work_arguments();
WorkOptions work_options(const py::dict& keywords);

/// Do `work`, which must not touch Python. It returns false, with the reason in `error`, on failure.
///
/// @param paths    the files that it reads
/// Throws what the progress callback raised, KeyboardInterrupt after a signal, FileNotFoundError if the work failed and
/// one of `paths` is not there, else vmlight.Error. Its messages go to the logger "vmlight", its warnings to Python's.
void do_work(const WorkOptions& options, const std::vector<std::string>& paths,
             const std::function<bool(const MakeOptions& options, std::string& error)>& work);

/// When Python exits, stop work of threads that it does not wait for, before they could no longer come back to it.
void stop_work_at_exit();

} // namespace vmlight::python
