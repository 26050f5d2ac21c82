#include "postproc/run/measured_points.hpp"

#include <fmt/format.h>

#include "geometry/base/csv_table.hpp"

namespace cutterflow::postproc {
namespace {

constexpr const char* k_speed = "speed_rpm";
constexpr const char* k_discharge = "discharge_m3_s";
constexpr const char* k_template_remedy = "Start from a template: cutterflow compare --measured-template";

void check_share(const CsvTable& table, std::size_t row, const std::string& column, std::vector<Mistake>& mistakes) {
    if (!table.has(column)) return;
    const double value = table.at(row, column);
    if (value >= 0.0 && value <= 1.0) return;
    mistakes.push_back({table.where(row), fmt::format("{} = {}", column, value), "It is a share by mass, from 0 to 1",
                        value > 1.0 ? "Divide percent by 100" : "Correct the field"});
}

void check_positive(const CsvTable& table, std::size_t row, const std::string& column, std::vector<Mistake>& mistakes) {
    if (!table.has(column) || table.at(row, column) > 0.0) return;
    mistakes.push_back(
        {table.where(row), fmt::format("{} = {}", column, table.at(row, column)), "It must be above 0", "Correct the field"});
}

void check_columns(const CsvTable& table, const std::string& file, std::vector<Mistake>& mistakes) {
    if (!table.has("spillage") && !table.has("production"))
        mistakes.push_back({file, "there is neither a column spillage nor a column production", "A test measures one of them, or both",
                            k_template_remedy});
    for (const std::string share : {"spillage", "production"})
        if (table.has(share + "_error") && !table.has(share))
            mistakes.push_back({file, fmt::format("there is a column {0}_error without {0}", share), "It is the error of that column",
                                fmt::format("Add {0}, or remove {0}_error", share)});
    if (table.rows() == 0) mistakes.push_back({file, "the file has no points", "One line below the header is one test", "Add lines"});
}

std::optional<MeasuredShare> share_of(const CsvTable& table, std::size_t row, const std::string& column) {
    if (!table.has(column)) return std::nullopt;
    MeasuredShare share{table.at(row, column), std::nullopt};
    if (table.has(column + "_error")) share.error = table.at(row, column + "_error");
    return share;
}

}  // namespace

MeasuredSeries read_measured_points(const std::filesystem::path& file) {
    if (!std::filesystem::is_regular_file(file))
        throw UserError(fmt::format("there is no file {}", file.string()), "It has the measured points", k_template_remedy);
    std::vector<Mistake> mistakes;
    const CsvTable table(file, {k_speed}, {k_discharge, "spillage", "spillage_error", "production", "production_error"}, mistakes);
    if (table.has(k_speed) && mistakes.empty()) check_columns(table, file.string(), mistakes);
    for (std::size_t row = 0; table.has(k_speed) && row < table.rows(); ++row) {
        check_positive(table, row, k_speed, mistakes);
        check_positive(table, row, k_discharge, mistakes);
        for (const char* column : {"spillage", "spillage_error", "production", "production_error"})
            check_share(table, row, column, mistakes);
    }
    if (!mistakes.empty()) throw UserError(std::move(mistakes));

    MeasuredSeries series{file.stem().string(), {}};
    for (std::size_t row = 0; row < table.rows(); ++row) {
        MeasuredPoint point{table.at(row, k_speed), std::nullopt, share_of(table, row, "spillage"), share_of(table, row, "production")};
        if (table.has(k_discharge)) point.discharge = table.at(row, k_discharge);
        series.points.push_back(point);
    }
    return series;
}

std::string measured_template() {
    return "# Spillage and production of tests, to stand beside runs: cutterflow compare RUN... --measured FILE.csv\n"
           "# One line is one test. Speed and discharge are those of the runs, in the model's scale. Spillage is the share of the cut\n"
           "# rock that was not delivered, production the share that was, both by mass, from 0 to 1; errors are half the 95 % interval.\n"
           "# Columns that were not measured are left out; one of spillage and production is enough.\n"
           "speed_rpm,discharge_m3_s,spillage,spillage_error,production,production_error\n";
}

}  // namespace cutterflow::postproc
