#pragma once
/// \file Headless Chromium, spoken to through its DevTools protocol on a pair of pipes.
#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace cutterflow::postproc::testing {

/// A browser with one page, ended with its profile when it goes out of scope.
class Chromium {
public:
    static bool is_installed();

    /// \throws std::runtime_error  when the browser does not answer
    Chromium();
    ~Chromium();
    Chromium(const Chromium&) = delete;
    Chromium& operator=(const Chromium&) = delete;

    /// Opens a file in a window of a given width [px] and waits until it has loaded. Forgets complaints() of the file before.
    void open(const std::filesystem::path& file, int width, int height);

    /// Value of a JavaScript expression; promises are waited for. \throws std::runtime_error when it throws
    nlohmann::json evaluate(const std::string& expression);

    void show_as_print(bool print);
    void allow_scripts(bool allow);

    /// What the page said on the console as warning or error, exceptions that nobody caught, and requests to anything but the file.
    const std::vector<std::string>& complaints() const { return complaints_; }

private:
    nlohmann::json call(const std::string& method, const nlohmann::json& parameters = nlohmann::json::object());
    nlohmann::json receive();
    void take(const nlohmann::json& event);

    pid_t pid_ = 0;
    int to_browser_ = -1, from_browser_ = -1;
    int last_call_ = 0;
    std::string session_, received_;
    std::filesystem::path profile_;
    bool loaded_ = false;
    std::vector<std::string> complaints_;
};

}  // namespace cutterflow::postproc::testing
