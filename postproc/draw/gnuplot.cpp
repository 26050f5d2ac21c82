#include "postproc/draw/gnuplot.hpp"

#include <fstream>
#include <iterator>
#include <regex>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/process/child_process.hpp"

namespace cutterflow::postproc {
namespace {

namespace fs = std::filesystem;

/// Settings of every plot: quiet axes, light grid, page colours.
constexpr const char* k_style = R"(set encoding utf8
set border 3 lc rgb "#8a94a0" lw 1
set tics nomirror out scale 0.5 textcolor rgb "#47525d"
set grid lc rgb "#e3e7eb" lw 1 lt 1
set xlabel textcolor rgb "#26303a"
set ylabel textcolor rgb "#26303a"
set key textcolor rgb "#26303a"
set style fill solid 1.0 noborder
)";

std::string read_text(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Coordinates of paths to a tenth of a pixel, which nobody sees, in place of a hundredth: pages are a sixth lighter.
std::string with_tenths(const std::string& svg) {
    static const std::regex coordinate("([ML,])(-?[0-9]+\\.[0-9]{2})(?![0-9])");
    std::string text;
    auto rest = svg.cbegin();
    for (std::sregex_iterator found(svg.begin(), svg.end(), coordinate), none; found != none; ++found) {
        text.append(rest, (*found)[2].first);
        text += fmt::format("{:.1f}", std::stod((*found)[2]));
        rest = (*found)[2].second;
    }
    return text.append(rest, svg.cend());
}

/// gnuplot's file as an element of a page: without prolog and tool tips, with ids of its own.
std::string as_element(const std::string& file, const std::string& name) {
    std::string svg = file.substr(file.find("<svg"));
    svg = std::regex_replace(svg, std::regex("<title>[^<]*</title>|<desc>[^<]*</desc>"), "");
    svg = std::regex_replace(svg, std::regex("id=(['\"])"), "id=$1" + name + "_");
    svg = std::regex_replace(svg, std::regex("href=(['\"])#"), "href=$1#" + name + "_");
    svg = std::regex_replace(svg, std::regex("url\\(#"), "url(#" + name + "_");
    return with_tenths(svg);
}

}  // namespace

bool gnuplot_is_installed() {
    return !find_program("gnuplot").empty();
}

std::string draw_svg(const Plot& plot, const fs::path& scratch_directory) {
    fs::create_directories(scratch_directory);
    const fs::path script = scratch_directory / (plot.name + ".gp");
    std::ofstream(script) << fmt::format("set terminal svg noenhanced size {},{} dynamic font \"sans-serif,12.5\"\nset output \"{}.svg\"\n",
                                         plot.width, plot.height, plot.name)
                          << k_style << gnuplot_commands(plot) << "unset output\n";
    // gnuplot runs in the scratch directory: the script contains no path of the user.
    require_child({{"gnuplot", script.filename().string()}, scratch_directory, scratch_directory / (plot.name + ".log"), {}});
    const std::string svg = read_text(scratch_directory / (plot.name + ".svg"));
    if (svg.find("<svg") == std::string::npos || svg.find("</svg>") == std::string::npos) {
        throw ToolError(
            {"", fmt::format("gnuplot drew nothing for {}", script.string()), "It writes an SVG file", "Read its log in the same folder"});
    }
    return as_element(svg, plot.name);
}

}  // namespace cutterflow::postproc
