#include "postproc/run/vtp_arrays.hpp"

#include <cstdlib>

namespace cutterflow::postproc {

std::optional<std::vector<double>> vtp_array(const std::string& text, const std::string& name) {
    const std::size_t named = text.find("Name=\"" + name + "\"");
    const std::size_t start = named == std::string::npos ? named : text.find('>', named);
    if (start == std::string::npos) return std::nullopt;
    std::vector<double> numbers;
    const char* at = text.c_str() + start + 1;
    for (char* end = nullptr;; at = end) {
        const double number = std::strtod(at, &end);
        if (end == at) return numbers;
        numbers.push_back(number);
    }
}

}  // namespace cutterflow::postproc
