#include <algorithm>
#include <functional>
#include <set>

#include <fmt/format.h>

#include "geometry/base/progress.hpp"
#include "postproc/draw/gnuplot.hpp"
#include "postproc/draw/html.hpp"
#include "validation/harness/suite/case_results.hpp"

namespace cutterflow::validation {
namespace {

constexpr const char* k_intro =
    "Made by `cutterflow verify` from the results of its cases; nothing here is typed. Reference, value and error stand in the "
    "quantity's unit, relative errors in %; a case that could not be run is skipped, never passed; what is only reported has no tolerance. "
    "A tolerance is the "
    "project's own requirement; an aim is stricter, and missing it has no consequence. The class says how much of a case was run: fast, "
    "standard or long. A row is of the program of its date; it is not repeated for every later change.";

std::string number(const std::optional<double>& value) {
    return value ? fmt::format("{:.6g}", *value) : std::string("–");
}

std::string share(double value) {
    return fmt::format("{:.3g} %", 100.0 * value);
}

std::string error_text(const VerifiedQuantity& q) {
    if (!q.error || (q.rule != Rule::relative && q.rule != Rule::absolute)) return "–";
    return q.rule == Rule::relative ? share(*q.error) : fmt::format("{:.3g}", *q.error);
}

std::string limit_text(const VerifiedQuantity& q, const std::optional<double>& limit) {
    if (!limit) return "–";
    const char* sign = q.rule == Rule::at_least ? "≥" : "≤";
    return fmt::format("{} {}", sign, q.rule == Rule::relative ? share(*limit) : fmt::format("{:.3g}", *limit));
}

std::string tolerance_text(const VerifiedQuantity& q) {
    std::string text = limit_text(q, q.tolerance);
    if (q.aim) text += fmt::format(" (aim {})", limit_text(q, q.aim));
    return text;
}

std::string name_text(const VerifiedQuantity& q) {
    return q.unit == "-" ? q.name : fmt::format("{} [{}]", q.name, q.unit);
}

/// What the two kinds of page write differently.
struct Markup {
    std::function<std::string(const std::string&)> escape;
    std::function<std::string(CaseVerdict)> verdict;
    std::function<std::string(const std::string& text, const std::string& target)> link;
};

const std::vector<std::string> k_quantity_header{"quantity", "reference", "value", "error", "tolerance", "verdict", "source"};

std::vector<std::vector<std::string>> quantity_rows(const VerifiedCase& result, const Markup& markup) {
    std::vector<std::vector<std::string>> rows;
    for (const VerifiedQuantity& q : result.quantities)
        rows.push_back({markup.escape(name_text(q)), number(q.reference), number(q.value), error_text(q), tolerance_text(q),
                        markup.verdict(q.verdict), markup.escape(q.source)});
    return rows;
}

const std::vector<std::string> k_case_header{"case", "what", "passed", "verdict", "core seconds", "class", "date"};

std::vector<std::vector<std::string>> case_rows(const std::vector<VerifiedCase>& results, const Markup& markup) {
    std::vector<std::vector<std::string>> rows;
    for (const VerifiedCase& result : results) {
        const auto count = [&](auto&& test) { return std::count_if(result.quantities.begin(), result.quantities.end(), test); };
        const auto passed = count([](const VerifiedQuantity& q) { return q.verdict == CaseVerdict::pass; });
        const auto judged = count([](const VerifiedQuantity& q) { return q.verdict != CaseVerdict::reported; });
        rows.push_back({markup.link(result.name, "#" + result.name), markup.escape(result.title), fmt::format("{} of {}", passed, judged),
                        markup.verdict(result.verdict()), fmt::format("{:.0f}", result.core_s), result.effort, result.date});
    }
    return rows;
}

/// Everything that did not pass, with its cause.
std::vector<std::string> shortfalls(const std::vector<VerifiedCase>& results, const Markup& markup) {
    std::vector<std::string> lines;
    for (const VerifiedCase& result : results) {
        if (!result.reason.empty())
            lines.push_back(fmt::format("{}, {}: {}", markup.link(result.name, "#" + result.name), markup.verdict(result.verdict()),
                                        markup.escape(result.reason)));
        for (const VerifiedQuantity& q : result.quantities) {
            if (q.verdict == CaseVerdict::pass || q.verdict == CaseVerdict::reported) continue;
            const std::string found = q.rule == Rule::relative || q.rule == Rule::absolute ? error_text(q) : number(q.value);
            lines.push_back(fmt::format("{}, {}, {}: {} where {} is asked. {}", markup.link(result.name, "#" + result.name),
                                        markup.escape(name_text(q)), markup.verdict(q.verdict), found, limit_text(q, q.tolerance),
                                        markup.escape(q.note)));
        }
    }
    return lines;
}

/// What passed and is not as good as it was hoped to be.
std::vector<std::string> missed_aims(const std::vector<VerifiedCase>& results, const Markup& markup) {
    std::vector<std::string> lines;
    for (const VerifiedCase& result : results)
        for (const VerifiedQuantity& q : result.quantities) {
            if (q.verdict != CaseVerdict::pass || !q.aim || !q.error) continue;
            if (q.rule == Rule::at_least ? *q.error >= *q.aim : *q.error <= *q.aim) continue;
            const std::string found = q.rule == Rule::relative || q.rule == Rule::absolute ? error_text(q) : number(q.value);
            lines.push_back(fmt::format("{}, {}: {} where {} is the aim", markup.link(result.name, "#" + result.name),
                                        markup.escape(name_text(q)), found, limit_text(q, q.aim)));
        }
    return lines;
}

/// The notes of a case, each once, with their quantities.
std::vector<std::string> notes(const VerifiedCase& result, const Markup& markup) {
    std::vector<std::string> lines;
    std::set<std::string> said;
    for (const VerifiedQuantity& q : result.quantities) {
        if (q.note.empty() || !said.insert(q.note).second) continue;
        std::vector<std::string> names;
        for (const VerifiedQuantity& other : result.quantities)
            if (other.note == q.note) names.push_back(other.name);
        const std::string of =
            names.size() > 3 ? fmt::format("{} to {}", names.front(), names.back()) : fmt::format("{}", fmt::join(names, "; "));
        lines.push_back(fmt::format("{}: {}", markup.escape(of), markup.escape(q.note)));
    }
    return lines;
}

std::string run_text(const VerifiedCase& result) {
    return fmt::format("Class {}, {:.1f} core seconds, {} UTC, {}.", result.effort, result.core_s, result.date, result.machine);
}

std::string count_text(const std::vector<VerifiedCase>& results) {
    int judged = 0, passed = 0;
    double core_s = 0.0;
    for (const VerifiedCase& result : results) {
        core_s += result.core_s;
        for (const VerifiedQuantity& q : result.quantities) {
            judged += q.verdict != CaseVerdict::reported;
            passed += q.verdict == CaseVerdict::pass;
        }
    }
    return fmt::format("{} of {} quantities of {} cases pass; {} on one core in all.", passed, judged, results.size(),
                       duration_text(core_s));
}

std::string markdown_table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows) {
    std::string text = fmt::format("| {} |\n|{}\n", fmt::join(header, " | "), [&] {
        std::string rule;
        for (std::size_t i = 0; i < header.size(); ++i) rule += "---|";
        return rule;
    }());
    for (const auto& row : rows) text += fmt::format("| {} |\n", fmt::join(row, " | "));
    return text + "\n";
}

std::string markdown_list(const std::vector<std::string>& lines) {
    return lines.empty() ? "" : fmt::format("* {}\n\n", fmt::join(lines, "\n* "));
}

std::string html_list(const std::vector<std::string>& lines) {
    return lines.empty() ? "" : fmt::format("<ul><li>{}</li></ul>\n", fmt::join(lines, "</li><li>"));
}

/// Sentences run over several lines, numbers do not.
bool has_sentences(const ExhibitTable& table) {
    constexpr std::size_t k_longest_label = 60;
    return std::any_of(table.rows.begin(), table.rows.end(), [](const auto& row) {
        return std::any_of(row.begin(), row.end(), [](const std::string& cell) { return cell.size() > k_longest_label; });
    });
}

/// Tables, and charts as tables.
std::vector<ExhibitTable> tables_of(const Exhibits& exhibits) {
    std::vector<ExhibitTable> tables = exhibits.tables;
    for (const Chart& chart : exhibits.charts) tables.push_back(chart_table(chart));
    return tables;
}

std::string exhibits_markdown(const Exhibits& exhibits, const Markup& markup) {
    std::string text;
    for (ExhibitTable table : tables_of(exhibits)) {
        for (auto& row : table.rows) std::transform(row.begin(), row.end(), row.begin(), markup.escape);
        text += fmt::format("### {}\n\n{}", table.title, markdown_table(table.columns, table.rows));
    }
    return text;
}

std::string exhibits_html(const VerifiedCase& result, const std::filesystem::path& scratch) {
    std::string text;
    const bool draws = postproc::gnuplot_is_installed();
    for (ExhibitTable table : draws ? result.exhibits.tables : tables_of(result.exhibits)) {
        for (auto& row : table.rows) std::transform(row.begin(), row.end(), row.begin(), postproc::html::escape);
        text += fmt::format("<h3>{}</h3>\n{}", postproc::html::escape(table.title),
                            postproc::html::table(table.columns, table.rows, !has_sentences(table)));
    }
    std::string figures;
    for (std::size_t i = 0; draws && i < result.exhibits.charts.size(); ++i) {
        const Chart& chart = result.exhibits.charts[i];
        figures += postproc::html::figure(postproc::draw_svg(chart_plot(chart, fmt::format("{}_{}", result.name, i)), scratch),
                                          postproc::html::escape(chart.title));
    }
    return figures.empty() ? text : text + "<div class=\"figures\">" + figures + "</div>\n";
}

std::string without_backticks(std::string text) {
    text.erase(std::remove(text.begin(), text.end(), '`'), text.end());
    return text;
}

}  // namespace

std::string quantity_text(const VerifiedQuantity& q) {
    std::string text = fmt::format("{:13} {} = {}", verdict_text(q.verdict), name_text(q), number(q.value));
    if (q.reference) text += fmt::format(", reference {}", number(q.reference));
    if (error_text(q) != "–") text += fmt::format(", error {}", error_text(q));
    if (q.tolerance) text += fmt::format(", asked {}", tolerance_text(q));
    return text;
}

std::string verification_text(const VerifiedCase& result) {
    std::string text = fmt::format("{}: {} ({:.1f} core s)\n", result.name, verdict_text(result.verdict()), result.core_s);
    if (!result.reason.empty()) text += fmt::format("    {}\n", result.reason);
    for (const VerifiedQuantity& q : result.quantities) text += "    " + quantity_text(q) + "\n";
    return text;
}

std::string verification_markdown(const std::vector<VerifiedCase>& results, const std::string& link) {
    const Markup markup{[](std::string text) {
                            for (std::size_t i = 0; (i = text.find('|', i)) != std::string::npos; i += 2) text.insert(i, "\\");
                            std::replace(text.begin(), text.end(), '\n', ' ');
                            return text;
                        },
                        [](CaseVerdict verdict) {
                            return verdict == CaseVerdict::fail || verdict == CaseVerdict::not_converged
                                       ? "**" + verdict_text(verdict) + "**"
                                       : verdict_text(verdict);
                        },
                        [](const std::string& text, const std::string& target) { return fmt::format("[{}]({})", text, target); }};
    std::string text = fmt::format("# Validation\n\n{}\n\n{}\n\n", k_intro, count_text(results));
    text += markdown_table(k_case_header, case_rows(results, markup));
    const std::vector<std::string> short_of = shortfalls(results, markup);
    text += "## What falls short\n\n" + (short_of.empty() ? std::string("Nothing of what is listed here.\n\n") : markdown_list(short_of));
    const std::vector<std::string> aims = missed_aims(results, markup);
    if (!aims.empty()) text += "Passed, but not as good as aimed at:\n\n" + markdown_list(aims);
    for (const VerifiedCase& result : results) {
        text += fmt::format("## {}\n\n{}. [How it is set up]({}{}/README.md). {}\n\n", result.name, result.title, link, result.name,
                            run_text(result));
        if (!result.quantities.empty()) text += markdown_table(k_quantity_header, quantity_rows(result, markup));
        text += exhibits_markdown(result.exhibits, markup);
        text += markdown_list(notes(result, markup));
    }
    text.pop_back();
    return text;
}

std::string verification_page(const std::vector<VerifiedCase>& results, const std::string& link, const std::filesystem::path& scratch) {
    const Markup markup{postproc::html::escape,
                        [](CaseVerdict verdict) {
                            const char* css = verdict == CaseVerdict::pass                                            ? "passed"
                                              : verdict == CaseVerdict::fail || verdict == CaseVerdict::not_converged ? "failed"
                                                                                                                      : "";
                            return fmt::format("<span class=\"{}\">{}</span>", css, verdict_text(verdict));
                        },
                        [](const std::string& text, const std::string& target) {
                            return fmt::format("<a href=\"{}\">{}</a>", target, postproc::html::escape(text));
                        }};
    std::string body = fmt::format("<header><h1>Validation</h1><p class=\"operating\">{}</p></header>\n<p class=\"scope\">{}</p>\n",
                                   postproc::html::escape(count_text(results)), without_backticks(postproc::html::escape(k_intro)));
    body += postproc::html::table(k_case_header, case_rows(results, markup), false);
    const std::vector<std::string> short_of = shortfalls(results, markup);
    const std::vector<std::string> aims = missed_aims(results, markup);
    body += postproc::html::section("What falls short",
                                    (short_of.empty() ? "<p>Nothing of what is listed here.</p>" : html_list(short_of)) +
                                        (aims.empty() ? "" : "<p>Passed, but not as good as aimed at:</p>" + html_list(aims)));
    for (const VerifiedCase& result : results) {
        std::string content =
            fmt::format("<p id=\"{}\">{}. {}. {}</p>", result.name, postproc::html::escape(result.title),
                        markup.link("How it is set up", link + result.name + "/README.md"), postproc::html::escape(run_text(result)));
        if (!result.quantities.empty()) content += postproc::html::table(k_quantity_header, quantity_rows(result, markup), true);
        content += exhibits_html(result, scratch);
        content += html_list(notes(result, markup));
        body += postproc::html::section(result.name, content);
    }
    return postproc::html::document("Validation", "<div class=\"verification\">" + body + "</div>", "");
}

}  // namespace cutterflow::validation
