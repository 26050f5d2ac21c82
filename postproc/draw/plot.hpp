#pragma once
/// \file A plot as data. gnuplot.hpp draws it as a static picture, plotly.hpp as one that answers the mouse; both show the same numbers.
/// Texts are plain: the renderers escape them. Coordinates are in the units of the axes; NaN breaks a line.
#include <optional>
#include <string>
#include <vector>

#include "postproc/draw/palette.hpp"

namespace cutterflow::postproc {

/// A value on an axis with a text of its own.
struct Tick {
    double at;
    std::string text;
};

/// How tool tips write a value of an axis: `digits` as in a format of C without its percent sign (".3f"), text around it.
struct TipFormat {
    std::string digits;  ///< empty: tool tips leave the value out
    std::string after;   ///< such as the unit
    std::string before = {};
};

struct Axis {
    std::string title = {};  ///< with the unit
    TipFormat tip = {};
    std::optional<double> from = {}, to = {};  ///< from the data when absent
    bool logarithmic = false;
    std::optional<double> step = {};  ///< between ticks; on a logarithmic axis the factor
    std::vector<Tick> ticks = {};     ///< the only ticks, when there are any
    std::string tick_suffix = {};
    std::string colour = palette::ink;
    bool grid = true;
    bool zero_line = false;
    bool visible = true;
};

enum class Mark { none, disc, ring, square, open_square, diamond, open_diamond, triangle, open_triangle, triangle_down, cross, plus };

/// Points, a line through them, or both. A series with neither line nor mark is only felt by tool tips.
struct Series {
    std::string name = {};  ///< in legend and tool tips; a series without name and point names is in neither
    std::string colour = palette::ink;
    std::vector<double> x, y;
    double line_width = 0.0;  ///< [px]; 0: no line
    bool dashed = false;
    Mark mark = Mark::none;
    double mark_size = 8.0;                       ///< [px]
    std::vector<double> x_low = {}, x_high = {};  ///< ends of error bars, or empty
    std::vector<double> y_low = {}, y_high = {};  ///< ends of error bars, or empty
    std::vector<std::string> point_names = {};    ///< first line of tool tips
    bool upper_axis = false;                      ///< x belongs to the upper axis
};

/// What lies between two curves.
struct Area {
    std::string name, colour;
    std::vector<double> x, low, high;
    bool stacked = false;  ///< one of several that add up: tool tips give its height instead of its borders
};

/// A horizontal bar of a given thickness about y = `at`.
struct Bar {
    double from, to, at, thickness;
    std::string colour;
    std::string tip;
    std::string label = {}, label_colour = palette::ink;  ///< in its middle
};

/// A shaded range of x over the whole height.
struct Band {
    double from, to;
    std::string colour, label;
};

/// A filled outline; NaN separates its parts.
struct Polygon {
    std::string colour;
    std::vector<double> x, y;
};

/// A circle about the origin.
struct Circle {
    double radius;
    std::string colour;
};

/// A text in the plot, its middle at x, y.
struct Text {
    std::string text;
    double x, y;
    std::string colour = palette::ink;
    double size = 12.5;  ///< [px]
};

/// Values on a regular grid of points as colours from light to dark. NaN is white.
struct Field {
    std::vector<double> x, y, value;
    double darkest = 1.0;  ///< value of the darkest colour, and more; the lightest is 0
    std::string unit;
    TipFormat tip;
};

/// What tool tips are gathered for: all series at one x, at one y, or the nearest point.
enum class Tips { at_x, at_y, at_point };

enum class Legend { none, above, right };

struct Plot {
    std::string name;  ///< letters, digits and underscores, unique in its page
    int width = 540;   ///< [px]
    int height = 330;  ///< [px]
    Axis x = {}, y = {};
    std::optional<Axis> upper_x = {};
    bool equal_scales = false;  ///< a unit is as long on both axes
    Tips tips = Tips::at_x;
    Legend legend = Legend::above;
    std::string legend_title = {};
    // Drawn in this order.
    std::optional<Field> field = {};
    std::vector<Band> bands = {};
    std::vector<Circle> circles = {};
    std::vector<Polygon> polygons = {};
    std::vector<Area> areas = {};
    std::vector<Bar> bars = {};
    std::vector<Series> series = {};
    std::vector<Text> texts = {};
};

/// Whether legend and tool tips know a series.
inline bool is_named(const Series& series) {
    return !series.name.empty() || !series.point_names.empty();
}

/// A plot with what stands below it. Adding one to a page is adding a row to the page's list.
struct Figure {
    Plot plot;
    std::string caption;    ///< markup
    std::string css_class;  ///< of the page's style sheet, or empty
};

}  // namespace cutterflow::postproc
