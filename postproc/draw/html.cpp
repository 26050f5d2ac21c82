#include "postproc/draw/html.hpp"

#include <chrono>
#include <ctime>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "postproc/draw/scripts.hpp"

namespace cutterflow::postproc::html {
namespace {

constexpr const char* k_style_sheet = R"css(
:root { --ink: #26303a; --soft: #5a6672; --line: #dfe4e9; --tint: #f5f7f9; }
* { box-sizing: border-box; }
html { font-family: system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", "Liberation Sans", Arial, sans-serif; font-size: 16px;
  color: var(--ink); background: #fff; line-height: 1.5; }
body { max-width: 1180px; margin: 0 auto; padding: 36px 32px 64px; }
header { border-bottom: 2px solid var(--ink); padding-bottom: 14px; margin-bottom: 20px; }
h1 { font-size: 1.75rem; line-height: 1.2; margin: 0 0 4px; font-weight: 650; letter-spacing: -0.01em; overflow-wrap: anywhere; }
h2 { font-size: 1.18rem; margin: 44px 0 12px; font-weight: 650; border-bottom: 1px solid var(--line); padding-bottom: 6px; }
p { margin: 0 0 10px; max-width: 78ch; }
.operating { color: var(--soft); margin: 0; max-width: none; }
.scope { border-left: 4px solid #f0c14b; background: #fdf8ea; padding: 10px 14px; margin: 18px 0; max-width: none; }
.notice { border-left: 4px solid #d55e00; background: #fdf1ea; padding: 10px 14px; margin: 0 0 20px; max-width: none; }
.answers { display: grid; grid-template-columns: repeat(auto-fit, minmax(230px, 1fr)); gap: 14px; margin: 0 0 14px; }
.answer { border: 1px solid var(--line); border-top: 4px solid var(--colour, var(--ink)); border-radius: 3px; padding: 12px 16px 14px; }
.answer .label { font-size: 0.86rem; color: var(--soft); line-height: 1.35; min-height: 2.7em; }
.answer .value { font-size: 2.1rem; line-height: 1.2; font-weight: 650; font-variant-numeric: tabular-nums; letter-spacing: -0.01em; }
.answer .detail { font-size: 0.86rem; color: var(--soft); }
.trust { font-size: 0.92rem; margin: 16px 0 0; padding: 0; list-style: none; }
.trust li { padding: 7px 0; border-top: 1px solid var(--line); display: grid; grid-template-columns: 11em 1fr; gap: 14px; }
.trust b { font-weight: 600; }
.trust span { overflow-wrap: anywhere; }
.figures { display: grid; grid-template-columns: repeat(2, minmax(0, 1fr)); gap: 26px 30px; align-items: start; }
figure { margin: 0; break-inside: avoid; min-width: 0; }
figure.wide { grid-column: 1 / -1; }
figure.head { display: grid; grid-template-columns: 13fr 10fr; gap: 10px; align-items: center; }
figure.head figcaption { grid-column: 1 / -1; }
figure.rose .replaceable, figure.rose .static { max-width: 430px; margin: 0 auto; }
.views { display: grid; grid-template-columns: repeat(3, minmax(0, 1fr)); gap: 18px; }
figure > svg, .views svg, .static svg { display: block; width: 100%; height: auto; }
.static svg text { font-family: inherit; }
figure + table { margin-top: 18px; }
figcaption { font-size: 0.86rem; color: var(--soft); margin-top: 6px; }
.replaceable.drawn .static { display: none; }
.replaceable .live { position: relative; width: 100%; }
.replaceable .live canvas { display: block; width: 100%; height: 100%; cursor: grab; }
.hint { display: none; }
section:has([data-kind=head].drawn) .hint { display: inline; }
.legend { list-style: none; margin: 4px 0 0; padding: 0; display: flex; flex-wrap: wrap; gap: 4px 20px; font-size: 0.9rem; }
.legend i { display: inline-block; width: 0.8em; height: 0.8em; border-radius: 50%; margin-right: 0.45em; vertical-align: -0.05em; }
.tables > div, .scroll { min-width: 0; overflow-x: auto; }
.tables { display: grid; grid-template-columns: repeat(2, minmax(0, 1fr)); gap: 18px 34px; align-items: start; }
table { border-collapse: collapse; width: 100%; font-size: 0.9rem; break-inside: auto; }
th, td { padding: 5px 12px 5px 0; text-align: left; vertical-align: top; border-bottom: 1px solid var(--line); overflow-wrap: anywhere; }
tr { break-inside: avoid; }
thead th { color: var(--soft); font-weight: 600; border-bottom: 1.5px solid #b8c1ca; }
tbody th { font-weight: 500; }
.settings th, .settings td { overflow-wrap: normal; }
.settings .name { overflow-wrap: anywhere; }
table + table, table + p { margin-top: 14px; }
sup { font-size: 0.72em; line-height: 0; }
sub { font-size: 0.72em; line-height: 0; }
table.numbers td, table.numbers thead th:not(:first-child) { text-align: right; font-variant-numeric: tabular-nums; }
table.numbers th, table.numbers td { overflow-wrap: normal; }
table.numbers td, table.numbers tbody th { white-space: nowrap; }
.tables table.numbers tbody th { white-space: normal; }
table.numbers td:last-child, table.numbers thead th:last-child { padding-right: 2px; }
.verification th, .verification td { overflow-wrap: normal; }
.verification table.numbers tbody th { white-space: normal; min-width: 16em; }
h3 { font-size: 0.95rem; margin: 14px 0 6px; font-weight: 600; }
.passed { color: #00795c; } .failed { color: #b3361b; font-weight: 650; }
footer { margin-top: 44px; border-top: 1px solid var(--line); padding-top: 10px; font-size: 0.82rem; color: var(--soft); }
@media (max-width: 900px) {
  body { padding: 22px 20px 48px; }
  .answers { grid-template-columns: repeat(2, minmax(0, 1fr)); }
  .figures, .tables { grid-template-columns: minmax(0, 1fr); }
  .figures figure:not(.wide) { max-width: 640px; }
  .trust li { grid-template-columns: 8.5em 1fr; }
  table.numbers tbody th { white-space: normal; }
}
@media print {
  @page { size: A4; margin: 14mm; }
  html { font-size: 12px; }
  body { max-width: none; padding: 0; }
  table { font-size: 0.78rem; }
  th, td { padding-right: 7px; }
  .tables { gap: 12px 22px; }
  .tables > div { overflow: visible; }
  .answers { grid-template-columns: repeat(4, minmax(0, 1fr)); }
  .figures, .tables { grid-template-columns: repeat(2, minmax(0, 1fr)); }
  h2 { break-after: avoid; }
  .replaceable.drawn .static { display: block; }
  .replaceable .live, section:has([data-kind=head].drawn) .hint { display: none; }
  * { -webkit-print-color-adjust: exact; print-color-adjust: exact; }
}
)css";

/// JSON for a script element: "<" would begin markup.
std::string script_text(const nlohmann::json& data) {
    std::string text = data.dump();
    for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at)) text.replace(at, 1, "\\u003c");
    return text;
}

constexpr const char* k_kind = "data-kind=\"{}\"";

/// The scripts that the replaceable pieces of a page need.
std::string scripts_for(const std::string& body) {
    const auto holds = [&](const char* kind) { return body.find(fmt::format(k_kind, kind)) != std::string::npos; };
    std::string scripts;
    if (holds("plot")) scripts += fmt::format("<script>{}</script>\n", scripts::plotly());
    if (holds("head")) scripts += fmt::format("<script>{}</script>\n", scripts::three());
    return scripts.empty() ? "" : scripts + fmt::format("<script>{}</script>\n", scripts::page());
}

}  // namespace

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

std::string scrolling(const std::string& table) {
    return "<div class=\"scroll\">" + table + "</div>\n";
}

std::string figure(const std::string& content, const std::string& caption, const std::string& css_class) {
    return fmt::format("<figure{}>{}<figcaption>{}</figcaption></figure>\n",
                       css_class.empty() ? "" : fmt::format(" class=\"{}\"", css_class), content, caption);
}

std::string replaceable(const std::string& content, const std::string& kind, const nlohmann::json& data) {
    return fmt::format("<div class=\"replaceable\" {}><div class=\"static\">{}</div><script type=\"application/json\">{}</script></div>",
                       fmt::format(k_kind, kind), content, script_text(data));
}

std::string data(const std::string& id, const nlohmann::json& data) {
    return fmt::format("<script type=\"application/json\" id=\"{}\">{}</script>\n", id, script_text(data));
}

std::string legend(const std::vector<std::pair<std::string, std::string>>& entries) {
    std::string items;
    for (const auto& [colour, text] : entries) items += fmt::format("<li><i style=\"background: {}\"></i>{}</li>", colour, text);
    return "<ul class=\"legend\">" + items + "</ul>";
}

std::string section(const std::string& title, const std::string& content) {
    return fmt::format("<section><h2>{}</h2>\n{}</section>\n", title, content);
}

std::string notices(const std::vector<std::string>& texts) {
    std::string markup;
    for (const std::string& text : texts) markup += fmt::format("<p class=\"notice\">{}.</p>\n", escape(text));
    return markup;
}

std::string answer(const char* colour, const std::string& label, const std::string& value, const std::string& detail) {
    return fmt::format(
        "<div class=\"answer\" style=\"--colour: {}\"><div class=\"label\">{}</div><div class=\"value\">{}</div>"
        "<div class=\"detail\">{}</div></div>\n",
        colour, label, value, detail);
}

std::string document(const std::string& title, const std::string& body, const std::string& footer) {
    const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
        "img-src 'self' data: blob:\">"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
        "<title>{} – Cutterflow</title><style>{}</style></head><body>\n{}"
        "<footer>Written by Cutterflow on {:%Y-%m-%d %H:%M} UTC. {}</footer>\n"
        "{}</body></html>\n",
        title, k_style_sheet, body, fmt::gmtime(now), footer, scripts_for(body));
}

}  // namespace cutterflow::postproc::html
