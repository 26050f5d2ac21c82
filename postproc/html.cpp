#include "postproc/html.hpp"

#include <fmt/format.h>

namespace cutterflow::postproc::html {

std::string escape(const std::string& text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '"':
                result += "&quot;";
                break;
            case '\'':
                result += "&#39;";
                break;
            default:
                result += c;
        }
    }
    return result;
}

std::string table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows, bool numeric) {
    std::string result = numeric ? "<table class=\"numbers\">" : "<table>";
    if (!header.empty()) {
        result += "<thead><tr>";
        for (const std::string& cell : header) result += fmt::format("<th scope=\"col\">{}</th>", cell);
        result += "</tr></thead>";
    }
    result += "<tbody>";
    for (const auto& row : rows) {
        result += "<tr>";
        for (std::size_t i = 0; i < row.size(); ++i) {
            result += i == 0 ? fmt::format("<th scope=\"row\">{}</th>", row[i]) : fmt::format("<td>{}</td>", row[i]);
        }
        result += "</tr>";
    }
    return result + "</tbody></table>\n";
}

std::string figure(const std::string& content, const std::string& caption, const std::string& css_class) {
    return fmt::format("<figure{}>{}<figcaption>{}</figcaption></figure>\n",
                       css_class.empty() ? "" : fmt::format(" class=\"{}\"", css_class), content, caption);
}

std::string section(const std::string& title, const std::string& content) {
    return fmt::format("<section><h2>{}</h2>\n{}</section>\n", title, content);
}

}  // namespace cutterflow::postproc::html
