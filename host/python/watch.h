// A long call on behalf of Python: progress is told, Ctrl-C heard, and what the callbacks raise is kept until
// the call has ended in good order.
#pragma once
#include <cxxabi.h>
#include <pybind11/pybind11.h>
#include <unistd.h>

#include <atomic>
#include <exception>
#include <string>
#include <thread>

namespace mcdem::inline python {

class Watch {
public:
    /// `progress` is a callable or None. To be made on the thread that makes the call, with the GIL.
    explicit Watch(pybind11::object progress) : progress_(std::move(progress)) {}

    /// Each may be called without the GIL, from any thread.
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
    /// True once a signal's handler or a callback has raised.
    bool stop_wanted() {
        // Python hands signals to its main thread only; workers see what that has heard.
        if (std::this_thread::get_id() == caller_)
            ask_python([] {
                if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
            });
        return stop_;
    }
    /// Throws what a callback or a signal's handler has raised, if any has.
    void raise() const {
        if (error_) std::rethrow_exception(error_);
    }

private:
    template <class Ask>
    void ask_python(Ask ask) {
        if (stop_) return;
        try {
            const pybind11::gil_scoped_acquire gil;
            if (stop_) return;  // another thread has raised meanwhile
            try {
                ask();
            } catch (pybind11::error_already_set&) {
                error_ = std::current_exception();
                stop_ = true;
            }
        } catch (abi::__forced_unwind&) {
            // Python ends, and ends this daemon thread, which could not be unwound through what runs in it.
            while (true) pause();
        }
    }

    pybind11::object progress_;
    std::thread::id caller_ = std::this_thread::get_id();
    std::atomic<bool> stop_{false};
    std::exception_ptr error_;
};

}  // namespace mcdem::python
