// Support for long calls from Python: reports progress, handles Ctrl-C, and stores exceptions of callbacks
// until the call has ended cleanly.
#pragma once
#include <cxxabi.h>
#include <pybind11/pybind11.h>
#include <unistd.h>

#include <atomic>
#include <exception>
#include <string>
#include <thread>

#include "core/errors.h"
#include "ensemble/make_packings.h"

namespace mcdem::inline python {

class Watch {
public:
    /// `progress` is a callable or None. Must be constructed on the calling thread, with the GIL.
    explicit Watch(pybind11::object progress) : progress_(std::move(progress)) {}

    /// The functions below can be called without the GIL, from any thread.
    template <class... Arguments>
    void show_progress(const Arguments&... arguments) {
        ask_python([&] {
            if (!progress_.is_none()) progress_(arguments...);
        });
    }
    void warn(const std::string& message) {
        ask_python([&] {
            if (PyErr_WarnEx(PyExc_RuntimeWarning, message.c_str(), 2) != 0)
                throw pybind11::error_already_set();
        });
    }
    /// True after a signal handler or a callback has raised an exception.
    bool stop_wanted() {
        // Python handles signals only on its main thread; other threads see the result.
        if (std::this_thread::get_id() == caller_)
            ask_python([] {
                if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
            });
        return stop_;
    }
    /// Rethrows the exception of a callback or signal handler, if there is one.
    void raise() const {
        if (error_) std::rethrow_exception(error_);
    }

private:
    template <class Ask>
    void ask_python(Ask ask) {
        if (stop_) return;
        try {
            const pybind11::gil_scoped_acquire gil;
            if (stop_) return;  // another thread has raised an exception in the meantime
            try {
                ask();
            } catch (pybind11::error_already_set&) {
                error_ = std::current_exception();
                stop_ = true;
            }
        } catch (abi::__forced_unwind&) {
            // The interpreter is shutting down and stops this daemon thread, which cannot be unwound.
            while (true) pause();
        }
    }

    pybind11::object progress_;
    std::thread::id caller_ = std::this_thread::get_id();
    std::atomic<bool> stop_{false};
    std::exception_ptr error_;
};

/// Calls `work` without the GIL. Throws what it throws, or instead of Interrupted the exception that `watch`
/// has stored.
template <class Work>
auto without_gil(Watch& watch, Work work) {
    decltype(work()) result{};
    try {
        const pybind11::gil_scoped_release others_go_on;
        result = work();
    } catch (const Interrupted&) {
    }
    watch.raise();
    return result;
}

/// The same with the progress of a Python callable; `work` gets Callbacks.
template <class Work>
auto watched(pybind11::object progress, Work work) {
    Watch watch(std::move(progress));
    return without_gil(watch, [&] {
        return work(
            Callbacks{[&](double part) { watch.show_progress(part); }, [&] { return watch.stop_wanted(); }});
    });
}

}  // namespace mcdem::python
