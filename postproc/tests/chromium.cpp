#include "postproc/tests/chromium.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <stdexcept>

#include "geometry/base/process/child_process.hpp"
#include "postproc/tests/synthetic_run.hpp"

namespace cutterflow::postproc::testing {
namespace {

using nlohmann::json;

constexpr int k_patience_ms = 150000;  // a report takes 13 s of processor time, and machines may be busy

std::array<int, 2> make_pipe() {
    std::array<int, 2> ends{};
    // Above 10, so that 3 and 4, where Chromium looks, are free for dup2.
    if (pipe(ends.data()) != 0) throw std::runtime_error("no pipe");
    for (int& end : ends) {
        const int moved = fcntl(end, F_DUPFD_CLOEXEC, 10);
        close(end);
        end = moved;
    }
    return ends;
}

}  // namespace

bool Chromium::is_installed() {
    return !find_program("chromium").empty();
}

Chromium::Chromium() : profile_(fresh_directory("chromium_profile")) {
    const std::array<int, 2> commands = make_pipe(), answers = make_pipe();
    const std::string program = find_program("chromium").string(), profile = "--user-data-dir=" + profile_.string();
    const char* const arguments[] = {program.c_str(),
                                     "--headless=new",
                                     "--no-sandbox",
                                     "--remote-debugging-pipe",
                                     "--no-first-run",
                                     "--disable-dev-shm-usage",
                                     "--use-gl=angle",
                                     "--use-angle=swiftshader",
                                     "--enable-unsafe-swiftshader",
                                     "--disable-background-networking",
                                     "--host-resolver-rules=MAP * ~NOTFOUND",
                                     profile.c_str(),
                                     "about:blank",
                                     nullptr};
    pid_ = fork();
    if (pid_ == 0) {
        setpgid(0, 0);
        dup2(commands[0], 3);
        dup2(answers[1], 4);
        const int nowhere = ::open("/dev/null", O_WRONLY);  // after 3 and 4 are taken, or it would be one of them
        dup2(nowhere, 1);
        dup2(nowhere, 2);
        execv(program.c_str(), const_cast<char* const*>(arguments));
        _exit(127);
    }
    setpgid(pid_, pid_);
    close(commands[0]);
    close(answers[1]);
    to_browser_ = commands[1];
    from_browser_ = answers[0];
    const json target = call("Target.createTarget", {{"url", "about:blank"}});
    session_ = call("Target.attachToTarget", {{"targetId", target.at("targetId")}, {"flatten", true}}).at("sessionId");
    for (const char* domain : {"Page", "Runtime", "Log", "Network"}) call(std::string(domain) + ".enable");
}

Chromium::~Chromium() {
    close(to_browser_);
    close(from_browser_);
    kill(-pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    std::error_code ignored;
    std::filesystem::remove_all(profile_, ignored);
}

json Chromium::receive() {
    for (;;) {
        const std::size_t end = received_.find('\0');
        if (end != std::string::npos) {
            const json message = json::parse(received_.substr(0, end));
            received_.erase(0, end + 1);
            return message;
        }
        pollfd ready{from_browser_, POLLIN, 0};
        if (poll(&ready, 1, k_patience_ms) <= 0) throw std::runtime_error("Chromium does not answer");
        std::array<char, 65536> buffer{};
        const ssize_t count = read(from_browser_, buffer.data(), buffer.size());
        if (count <= 0) throw std::runtime_error("Chromium has ended");
        received_.append(buffer.data(), static_cast<std::size_t>(count));
    }
}

json Chromium::call(const std::string& method, const json& parameters) {
    json message{{"id", ++last_call_}, {"method", method}, {"params", parameters}};
    if (!session_.empty()) message["sessionId"] = session_;
    const std::string text = message.dump();
    if (write(to_browser_, text.c_str(), text.size() + 1) != static_cast<ssize_t>(text.size() + 1))
        throw std::runtime_error("Chromium takes no commands");
    for (;;) {
        const json answer = receive();
        if (answer.value("id", 0) == last_call_) {
            if (answer.contains("error")) throw std::runtime_error(method + ": " + answer.at("error").dump());
            return answer.at("result");
        }
        take(answer);
    }
}

void Chromium::take(const json& event) {
    const std::string method = event.value("method", "");
    const json parameters = event.value("params", json::object());
    if (method == "Page.loadEventFired") loaded_ = true;
    if (method == "Runtime.exceptionThrown") complaints_.push_back(parameters.at("exceptionDetails").dump());
    if (method == "Log.entryAdded") complaints_.push_back(parameters.at("entry").dump());
    if (method == "Runtime.consoleAPICalled") {
        const std::string kind = parameters.at("type");
        if (kind == "error" || kind == "warning" || kind == "assert") complaints_.push_back(parameters.at("args").dump());
    }
    if (method == "Network.requestWillBeSent") {
        const std::string address = parameters.at("request").at("url");
        const bool own = address.rfind("file:", 0) == 0 || address.rfind("data:", 0) == 0 || address.rfind("blob:", 0) == 0;
        if (!own) complaints_.push_back("request: " + address);
    }
}

void Chromium::open(const std::filesystem::path& file, int width, int height) {
    call("Emulation.setDeviceMetricsOverride", {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", false}});
    loaded_ = false;
    complaints_.clear();
    call("Page.navigate", {{"url", "file://" + std::filesystem::absolute(file).string()}});
    while (!loaded_) take(receive());
}

void Chromium::show_as_print(bool print) {
    call("Emulation.setEmulatedMedia", {{"media", print ? "print" : ""}});
}

void Chromium::allow_scripts(bool allow) {
    call("Emulation.setScriptExecutionDisabled", {{"value", !allow}});
}

json Chromium::evaluate(const std::string& expression) {
    const json answer = call("Runtime.evaluate", {{"expression", expression}, {"returnByValue", true}, {"awaitPromise", true}});
    if (answer.contains("exceptionDetails")) throw std::runtime_error(answer.at("exceptionDetails").dump());
    return answer.at("result").value("value", json());
}

}  // namespace cutterflow::postproc::testing
