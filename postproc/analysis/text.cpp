#include "postproc/analysis/text.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "postproc/draw/html.hpp"

namespace cutterflow::postproc::text {

using html::escape;

std::string percent(double share) {
    return fmt::format("{:.1f} %", 100.0 * share);
}

std::string percent(const std::optional<double>& share) {
    return share ? percent(*share) : std::string("undefined");
}

/// Number with `digits` significant digits: plain where people read it so, else with a power of ten.
std::string digits_of(double value, int digits) {
    if (std::abs(value) < 1e-300) return "0";  // also limits that say "above zero"
    if (!std::isfinite(value)) return k_dash;
    const int exponent = static_cast<int>(std::floor(std::log10(std::abs(value))));
    if (exponent < -4 || exponent > 6) {
        const std::string power = exponent < 0 ? fmt::format("−{}", -exponent) : fmt::format("{}", exponent);
        return fmt::format("{:.{}g}·10<sup>{}</sup>", value / std::pow(10.0, exponent), digits, power);
    }
    const double unit = std::pow(10.0, exponent - digits + 1);
    std::string text = fmt::format("{:.{}f}", std::round(value / unit) * unit, std::max(0, digits - 1 - exponent));
    if (text.find('.') == std::string::npos) return text;
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
}

std::string number(const std::optional<double>& value, const char* unit, int digits) {
    if (!value) return k_dash;
    return digits_of(*value, digits) + (*unit ? fmt::format(" {}", unit) : "");
}

/// Mean and standard error to the same decimal.
std::string number(const std::optional<TimeAverage>& average, const char* unit) {
    if (!average) return k_dash;
    const std::string tail = *unit ? fmt::format(" {}", unit) : "";
    if (!average->standard_error || *average->standard_error == 0.0) return digits_of(average->mean, 3) + tail;
    const int decimals = std::clamp(1 - static_cast<int>(std::floor(std::log10(*average->standard_error))), 0, 6);
    return fmt::format("{:.{}f} ± {:.{}f}{}", average->mean, decimals, *average->standard_error, decimals, tail);
}

std::string duration(double seconds) {
    if (seconds < 120.0) return fmt::format("{:.3g} s", seconds);
    if (seconds < 7200.0) return fmt::format("{:.1f} min", seconds / 60.0);
    return fmt::format("{:.1f} h", seconds / 3600.0);
}

/// "0-30mm" as "0–30 mm".
std::string bin_text(const std::string& name) {
    const std::size_t dash = name.find('-');
    if (dash == std::string::npos || name.size() < 2 || name.substr(name.size() - 2) != "mm")
        return name == "below_hub" ? "below hub" : escape(name);
    return escape(name.substr(0, dash) + "–" + name.substr(dash + 1, name.size() - dash - 3) + " mm");
}

std::optional<double> mean_of(const std::optional<TimeAverage>& average) {
    return average ? std::optional<double>(average->mean) : std::nullopt;
}

}  // namespace cutterflow::postproc::text
