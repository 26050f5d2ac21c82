#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "postproc/draw/gnuplot.hpp"

namespace cutterflow::postproc {
namespace {

std::string number(double value) {
    return std::isnan(value) ? "NaN" : fmt::format("{:.6g}", value);
}

/// Text as gnuplot reads it between double quotes.
std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        result += c == '\n' ? ' ' : c;
    }
    return result + '"';
}

/// Text in a format of gnuplot, where a percent sign is written as two.
std::string doubled_percent(std::string text) {
    for (std::size_t at = 0; (at = text.find('%', at)) != std::string::npos; at += 2) text.insert(at, "%");
    return text;
}

std::string colour(const std::string& hex) {
    return fmt::format("rgb \"{}\"", hex);
}

/// gnuplot's numbers of shapes.
int shape(Mark mark) {
    switch (mark) {
        case Mark::disc:
            return 7;
        case Mark::ring:
            return 6;
        case Mark::square:
            return 5;
        case Mark::open_square:
            return 4;
        case Mark::diamond:
            return 13;
        case Mark::open_diamond:
            return 12;
        case Mark::triangle:
            return 9;
        case Mark::open_triangle:
            return 8;
        case Mark::triangle_down:
            return 11;
        case Mark::cross:
            return 2;
        case Mark::plus:
            return 1;
        case Mark::none:
            break;
    }
    return 0;
}

/// The commands of one plot: settings and data blocks as they come up, and the parts of the one `plot` command.
class Commands {
public:
    explicit Commands(const Plot& plot) : plot_(plot) {}
    std::string text();

private:
    using Columns = std::vector<const std::vector<double>*>;

    template <typename... Arguments>
    void set(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
        settings_ += fmt::format(format, std::forward<Arguments>(arguments)...) + "\n";
    }
    void draw(const std::string& part) { parts_.push_back(part); }

    /// Writes columns as a data block. \param breaks  rows of NaN become empty: they end a line or an outline
    std::string block(const Columns& columns, bool breaks);
    void axis(const Axis& axis, const std::string& name);
    void frame();
    void fix_range(const Axis& axis, const std::string& name);
    void legend();
    void add(const Field& field);
    void add(const Band& band);
    void add(const Circle& circle);
    void add(const Polygon& polygon);
    void add(const Area& area);
    void add(const Bar& bar);
    void add(const Series& series);
    void add(const Text& text);

    const Plot& plot_;
    std::string settings_;
    std::vector<std::string> parts_;
    int blocks_ = 0;
    bool has_points_ = false;
};

std::string Commands::block(const Columns& columns, bool breaks) {
    const std::string name = fmt::format("$block{}", ++blocks_);
    settings_ += name + " << END_OF_DATA\n";
    for (std::size_t row = 0; row < columns.front()->size(); ++row) {
        std::string line;
        bool has_gap = false;
        for (const auto* column : columns) {
            has_gap = has_gap || std::isnan((*column)[row]);
            line += (line.empty() ? "" : " ") + number((*column)[row]);
        }
        settings_ += (breaks && has_gap ? "" : line) + "\n";
        has_points_ = has_points_ || (std::isfinite((*columns[0])[row]) && std::isfinite((*columns[1])[row]));
    }
    settings_ += "END_OF_DATA\n";
    return name;
}

/// \param name  "x", "y" or "x2"
void Commands::axis(const Axis& axis, const std::string& name) {
    const std::string tick_colour = axis.colour == palette::ink ? "" : "textcolor " + colour(axis.colour);
    if (!axis.title.empty()) set("set {}label {} textcolor {}", name, quoted(axis.title), colour(axis.colour));
    if (axis.logarithmic) set("set logscale {0}\nunset m{0}tics", name);
    if (axis.from || axis.to) {
        set("set {}range [{}:{}]{}", name, axis.from ? number(*axis.from) : "*", axis.to ? number(*axis.to) : "*",
            axis.from && axis.to ? "" : " noextend");
    }
    if (!axis.visible) {
        set("unset {}tics", name);
    } else if (!axis.ticks.empty()) {
        std::vector<std::string> ticks;
        for (const Tick& tick : axis.ticks) ticks.push_back(fmt::format("{} {}", quoted(tick.text), number(tick.at)));
        set("set {}tics nomirror ({}) {}", name, fmt::join(ticks, ", "), tick_colour);
    } else {
        set("set {}tics nomirror {} {}", name, axis.step ? number(*axis.step) : "", tick_colour);
        if (axis.logarithmic) set("set format {} \"%.0e\"", name);
        if (!axis.tick_suffix.empty()) set("set format {} {}", name, quoted("%g" + doubled_percent(axis.tick_suffix)));
    }
    if (name != "x2" && (!axis.grid || !axis.visible)) set("set grid no{}tics", name);
    if (axis.zero_line) set("set {}zeroaxis lt 1 lc {}", name == "y" ? "x" : "y", colour(palette::faint));
}

void Commands::frame() {
    axis(plot_.x, "x");
    axis(plot_.y, "y");
    if (plot_.upper_x) axis(*plot_.upper_x, "x2");
    if (plot_.equal_scales) set("set size ratio -1");
    if (!plot_.x.visible || !plot_.y.visible) set("set border {}", (plot_.x.visible ? 1 : 0) + (plot_.y.visible ? 2 : 0));
    if (!plot_.y.visible) set("set lmargin 3\nset rmargin 3\nset tmargin 0.4\nset bmargin {}", plot_.x.visible ? 1.6 : 0.4);
    const bool from_data = !plot_.x.from && !plot_.x.to && !plot_.x.logarithmic;
    if (from_data) set("set offsets graph 0.06,graph 0.06,0,0");
}

/// gnuplot finds no range where there is no point, and draws nothing then.
void Commands::fix_range(const Axis& axis, const std::string& name) {
    const auto beside = [&](double end, double steps) { return axis.logarithmic ? end * std::pow(10.0, steps) : end + steps; };
    const double from = axis.from.value_or(axis.to ? beside(*axis.to, -1.0) : (axis.logarithmic ? 1.0 : 0.0));
    set("set {}range [{}:{}]", name, number(from), number(axis.to.value_or(beside(from, 1.0))));
}

void Commands::legend() {
    const std::string title = plot_.legend_title.empty() ? "" : " title " + quoted(plot_.legend_title);
    if (plot_.legend == Legend::none) set("unset key");
    if (plot_.legend == Legend::above) set("set key outside top center horizontal samplen 2{}", title);
    if (plot_.legend == Legend::right) set("set key outside right top Left reverse{}", title);
}

void Commands::add(const Field& field) {
    std::vector<std::string> steps;
    for (const char* step : palette::field) steps.push_back(fmt::format("{} \"{}\"", steps.size(), step));
    set("set palette defined ({})\nset cblabel {}\nset cbrange [0:{}]", fmt::join(steps, ", "), quoted(field.unit),
        number(std::max(field.darkest, 1e-9)));
    draw(fmt::format("{} using 1:2:3 with image notitle", block({&field.x, &field.y, &field.value}, false)));
}

void Commands::add(const Band& band) {
    set("set object rectangle from {},graph 0 to {},graph 1 behind fc {} fs solid noborder", number(band.from), number(band.to),
        colour(band.colour));
    set("set label {} at {},graph 0.97 right rotate by 90 font \",11\" textcolor {}", quoted(band.label),
        number(0.5 * (band.from + band.to)), colour(palette::ink));
}

void Commands::add(const Circle& circle) {
    set("set object circle at 0,0 size {0} fc {1} fs empty border {1} lw 1 behind", number(circle.radius), colour(circle.colour));
}

void Commands::add(const Polygon& polygon) {
    draw(fmt::format("{} using 1:2 with filledcurves closed lc {} notitle", block({&polygon.x, &polygon.y}, true), colour(polygon.colour)));
}

void Commands::add(const Area& area) {
    draw(fmt::format("{} using 1:2:3 with filledcurves lc {} title {}", block({&area.x, &area.low, &area.high}, false), colour(area.colour),
                     quoted(area.name)));
    set("set grid front");
}

void Commands::add(const Bar& bar) {
    set("set object rectangle from {},{} to {},{} fc {} fs solid 1.0 noborder", number(bar.from), number(bar.at - 0.5 * bar.thickness),
        number(bar.to), number(bar.at + 0.5 * bar.thickness), colour(bar.colour));
    if (!bar.label.empty()) {
        set("set label {} at {},{} center front font \",14\" textcolor {}", quoted(bar.label), number(0.5 * (bar.from + bar.to)),
            number(bar.at), colour(bar.label_colour));
    }
}

void Commands::add(const Series& series) {
    const bool x_bars = !series.x_low.empty(), y_bars = !series.y_low.empty();
    if (series.x.empty() || (series.line_width == 0.0 && series.mark == Mark::none && !x_bars && !y_bars)) return;
    Columns columns{&series.x, &series.y};
    if (x_bars) columns.insert(columns.end(), {&series.x_low, &series.x_high});
    if (y_bars) columns.insert(columns.end(), {&series.y_low, &series.y_high});
    const std::string data = block(columns, series.line_width > 0.0);
    const std::string axes = series.upper_axis ? " axes x2y1" : "", hue = colour(series.colour);
    std::string title = series.name.empty() ? "notitle" : "title " + quoted(series.name);
    const auto part = [&](const std::string& style) {
        draw(fmt::format("{} {} {}", data, style, title));
        title = "notitle";
    };
    if (series.line_width > 0.0)
        part(fmt::format("using 1:2{} with lines lw {}{} lc {}", axes, series.line_width, series.dashed ? " dt 2" : "", hue));
    const std::string mark = fmt::format("pt {} ps {:.3g} lw 1.4 lc {}", shape(series.mark), 0.1 * series.mark_size, hue);
    if (x_bars || y_bars) {
        const char* style = x_bars && y_bars ? "1:2:3:4:5:6{} with xyerrorbars"
                            : x_bars         ? "1:2:3:4{} with xerrorbars"
                                             : "1:2:3:4{} with yerrorbars";
        part("using " + fmt::format(fmt::runtime(style), axes) + " " + mark);
    } else if (series.mark != Mark::none) {
        part(fmt::format("using 1:2{} with points {}", axes, mark));
    }
}

void Commands::add(const Text& text) {
    set("set label {} at {},{} center font \",{}\" textcolor {} front", quoted(text.text), number(text.x), number(text.y), text.size,
        colour(text.colour));
}

std::string Commands::text() {
    frame();
    legend();
    if (plot_.field) add(*plot_.field);
    for (const Band& band : plot_.bands) add(band);
    for (const Circle& circle : plot_.circles) add(circle);
    for (const Polygon& polygon : plot_.polygons) add(polygon);
    for (const Area& area : plot_.areas) add(area);
    for (const Bar& bar : plot_.bars) add(bar);
    for (const Series& series : plot_.series) add(series);
    for (const Text& text : plot_.texts) add(text);
    if (parts_.empty()) draw("NaN notitle");
    if (!has_points_) {
        fix_range(plot_.x, "x");
        fix_range(plot_.y, "y");
        if (plot_.upper_x) fix_range(*plot_.upper_x, "x2");
    }
    return settings_ + fmt::format("plot {}\n", fmt::join(parts_, ", "));
}

}  // namespace

std::string gnuplot_commands(const Plot& plot) {
    return Commands(plot).text();
}

}  // namespace cutterflow::postproc
