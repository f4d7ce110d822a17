// SPDX-License-Identifier: Apache-2.0
#include "work.h"

#include "messages.h"

#include <vmlight/base/format.h>

#include <OpenImageIO/filesystem.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

namespace vmlight::python {
namespace {

struct ThreadParams
{
    int threads = 0;

    template <class Visit> void visit(Visit&& field)
    {
        field("threads", threads, Range { 0, 1024 }, "Number of threads; 0: one per core");
    }
};

// How long a Ctrl-C can stay unseen.
constexpr std::chrono::milliseconds kSignalPeriod { 50 };
// A callback hears of steps of this size at once, of smaller ones with the next look for signals: Python would slow
// down the work that tells it more.
constexpr double kProgressStep = 0.01;

// The work in progress. Once Python exits, threads that it does not wait for cannot come back to it: work must end
// first.
class Ongoing
{
public:
    Ongoing()
    {
        if (s_exits)
            leave();
        ++s_count;
    }
    ~Ongoing() { --s_count; }
    Ongoing(const Ongoing&) = delete;
    Ongoing& operator=(const Ongoing&) = delete;

    static bool must_stop() { return s_exits; }
    // Ends the thread of Python.
    [[noreturn]] static void leave()
    {
        PyErr_SetNone(PyExc_SystemExit);
        throw py::error_already_set();
    }
    static void stop_all()
    {
        s_exits = true;
        const py::gil_scoped_release unlocked;
        while (s_count > 0)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }

private:
    inline static std::atomic<bool> s_exits { false };
    inline static std::atomic<int> s_count { 0 };
};

/// What the worker says, and the waiting thread hears.
class Talk
{
public:
    explicit Talk(bool wants_progress)
        : m_wants_progress(wants_progress)
    {
    }

    struct News
    {
        bool any = false;
        double done = 0;
        std::string step;
    };

    // For the worker.
    bool tell(const std::string& step, double done)
    {
        if (m_stopped || Ongoing::must_stop())
            return false;
        const std::lock_guard<std::mutex> lock(m_mutex);
        m_news.any |= m_wants_progress && (step != m_news.step || done != m_news.done);
        m_is_urgent |= m_news.any && (step != m_news.step || done >= m_told + kProgressStep || done >= 1);
        m_news.done = done;
        m_news.step = step;
        if (m_is_urgent) {
            m_told = done;
            m_wake.notify_one();
        }
        return !m_stopped;
    }
    void say(bool is_warning, const std::string& line)
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        messages.emplace_back(is_warning, line);
    }
    void finish()
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        m_finished = true;
        m_wake.notify_one();
    }

    // For who waits. Whether the work has ended; `news` is what has come since.
    bool wait(News& news)
    {
        std::unique_lock<std::mutex> lock(m_mutex);
        m_wake.wait_for(lock, kSignalPeriod, [&] { return m_finished || m_is_urgent; });
        news = m_news;
        m_news.any = m_is_urgent = false;
        return m_finished;
    }
    void stop() { m_stopped = true; }

    /// Whether each is a warning, and its text. Complete once the work has ended.
    std::vector<std::pair<bool, std::string>> messages;

private:
    const bool m_wants_progress;
    std::atomic<bool> m_stopped { false };
    std::mutex m_mutex;
    std::condition_variable m_wake;
    bool m_finished = false, m_is_urgent = false;
    News m_news;
    double m_told = 0;
};

MakeOptions make_options(Talk& talk, int threads)
{
    MakeOptions options;
    options.threads = threads;
    options.progress = [&talk](const std::string& step, int64_t) {
        return [&talk, step](double done) { return talk.tell(step, done); };
    };
    options.say = [&talk](const std::string& line) { talk.say(false, line); };
    options.warn = [&talk](const std::string& line) { talk.say(true, line); };
    return options;
}

// Let Python's signal handlers run, and tell the callback.
void attend(const Talk::News& news, const py::object& progress)
{
    if (PyErr_CheckSignals() != 0)
        throw py::error_already_set();
    if (news.any && !progress.is_none())
        progress(news.done, news.step);
}

void pass_on(const std::vector<std::pair<bool, std::string>>& messages, int warning_level)
{
    const py::object info = py::module_::import("logging").attr("getLogger")("vmlight").attr("info");
    for (const auto& [is_warning, line] : messages) {
        if (is_warning)
            warn(line, warning_level);
        else
            info("%s", in_python(line));
    }
}

} // namespace

std::vector<Argument> work_arguments()
{
    std::vector<Argument> arguments = arguments_of(ThreadParams());
    arguments.push_back({ "progress", "Callable[[float, str], object] | None", "None", "",
                          "Called with the share that is done, 0 to 1, and the name of the step; on the thread of the "
                          "call. What it raises stops the work" });
    return arguments;
}

WorkOptions work_options(const py::dict& keywords)
{
    ThreadParams params;
    set_params(params, keywords);
    WorkOptions options;
    options.threads = params.threads;
    if (keywords.contains("progress"))
        options.progress = keywords["progress"];
    if (!options.progress.is_none() && !PyCallable_Check(options.progress.ptr()))
        throw py::type_error(format("progress: must be callable, not {}", Py_TYPE(options.progress.ptr())->tp_name));
    return options;
}

void do_work(const WorkOptions& given, const std::vector<std::string>& paths,
             const std::function<bool(const MakeOptions& options, std::string& error)>& work)
{
    const Ongoing ongoing;
    Talk talk(!given.progress.is_none());
    bool done = false;
    std::string error;
    std::exception_ptr thrown;
    std::thread worker([&] {
        try {
            done = work(make_options(talk, given.threads), error);
        } catch (...) {
            thrown = std::current_exception();
        }
        talk.finish();
    });
    std::optional<py::error_already_set> raised;
    for (bool finished = false; !finished;) {
        Talk::News news;
        {
            const py::gil_scoped_release unlocked;
            finished = talk.wait(news);
        }
        if (raised)
            continue;
        try {
            attend(news, given.progress);
        } catch (py::error_already_set& exception) {
            raised.emplace(exception);
            talk.stop();
        }
    }
    {
        const py::gil_scoped_release unlocked;
        worker.join();
    }
    if (raised)
        throw py::error_already_set(*raised);
    if (!done && Ongoing::must_stop())
        Ongoing::leave();
    if (thrown)
        std::rethrow_exception(thrown);
    pass_on(talk.messages, given.warning_level);
    if (done)
        return;
    for (const std::string& path : paths)
        if (!path.empty() && path.find_first_of("?<") == std::string::npos && !OIIO::Filesystem::exists(path)) {
            PyErr_SetString(PyExc_FileNotFoundError, in_python(error).c_str());
            throw py::error_already_set();
        }
    throw_error(error);
}

void stop_work_at_exit()
{
    py::module_::import("atexit").attr("register")(py::cpp_function(&Ongoing::stop_all));
}

} // namespace vmlight::python
