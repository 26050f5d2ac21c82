#include "cases/cli/inspection_page.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "geometry/base/file_content.hpp"
#include "postproc/draw/gnuplot.hpp"
#include "postproc/draw/html.hpp"
#include "postproc/draw/palette.hpp"
#include "postproc/draw/rendering.hpp"

namespace cutterflow::cases {
namespace {

namespace fs = std::filesystem;
namespace html = postproc::html;
namespace palette = postproc::palette;

constexpr int k_picture = 560;     ///< pixels, square
constexpr double k_margin = 1.12;  ///< of a picture, over the surface's size
constexpr double k_mark = 0.012;   ///< radius of a defect's mark, of the largest extent
constexpr int k_plot_width = 1116;
constexpr const char* k_mark_colour = "#d5301a";

postproc::TriangleSurface corners_of(const geometry::TriangleSurface& surface) {
    postproc::TriangleSurface triangles;
    for (const geometry::Triangle& t : surface.triangles)
        triangles.push_back({surface.points[t[0]], surface.points[t[1]], surface.points[t[2]]});
    return triangles;
}

std::vector<const geometry::Defect*> defect_kinds(const geometry::SoundnessReport& report) {
    return {&report.degenerate_triangles, &report.duplicate_triangles, &report.border_edges,      &report.non_manifold_edges,
            &report.misoriented_edges,    &report.non_manifold_points, &report.self_intersections};
}

/// The surface with a ball at each place of a defect.
postproc::HeadScene scene_of(const geometry::TriangleSurface& surface, const geometry::SoundnessReport& report) {
    postproc::HeadScene scene;
    scene.steel = corners_of(surface);
    const double radius = k_mark * geometry::bounds_of(surface).extent().maxCoeff();
    for (const geometry::Defect* defect : defect_kinds(report))
        for (const Vec3& place : defect->places) scene.rocks.push_back({place, radius, postproc::colour_of(k_mark_colour)});
    return scene;
}

/// A bar of a round length in the lower left corner.
std::string scale_bar(const postproc::View& view) {
    double length = 1.0;
    while (length > 0.4 * view.height_m) length *= 0.1;
    for (const double factor : {5.0, 2.0})
        if (factor * length < 0.4 * view.height_m) {
            length *= factor;
            break;
        }
    const double pixels = length * view.height / view.height_m, y = view.height - 24.0;
    return fmt::format(
        "<path d=\"M16,{0} V{1} M16,{2} H{3:.1f} M{3:.1f},{0} V{1}\" fill=\"none\" stroke=\"{4}\" stroke-width=\"1.5\"/>"
        "<text x=\"{5:.1f}\" y=\"{6}\" font-size=\"15\" fill=\"{4}\">{7:g} m</text>",
        y - 5.0, y + 5.0, y, 16.0 + pixels, palette::ink, 24.0 + pixels, y + 5.0, length);
}

std::string picture(const postproc::HeadScene& scene, const geometry::Bounds& bounds, const Vec3& towards, const Vec3& upwards,
                    const std::string& label) {
    const Vec3 toward = towards.normalized();
    const Vec3 up = (upwards - upwards.dot(toward) * toward).normalized();
    postproc::View view{0.5 * (bounds.min + bounds.max), up.cross(toward), up, toward, 1.0, k_picture, k_picture};
    double reach = 0.0;
    for (const postproc::Triangle& triangle : scene.steel)
        for (const Vec3& corner : triangle)
            reach = std::max({reach, std::abs((corner - view.centre).dot(view.right)), std::abs((corner - view.centre).dot(view.up))});
    view.height_m = 2.0 * k_margin * reach;
    const std::string image = fmt::format(
        "<svg viewBox=\"0 0 {0} {0}\" role=\"img\" aria-label=\"{1}\"><image width=\"{0}\" height=\"{0}\" "
        "href=\"data:image/png;base64,{2}\"/>{3}</svg>",
        k_picture, label, postproc::base64(postproc::png_bytes(postproc::render(scene, view))), scale_bar(view));
    return html::figure(image, label);
}

/// A head is shown in its own frame, any other surface along the axes of its file.
std::string pictures(const geometry::GeometryInspection& inspection, const geometry::TriangleSurface& surface) {
    std::string figures;
    if (inspection.head) {
        const geometry::TriangleSurface& head = inspection.head->surface;
        const postproc::HeadScene scene = scene_of(head, {});
        const geometry::Bounds bounds = geometry::bounds_of(head);
        figures = picture(scene, bounds, Vec3(0.35, -1.0, 0.3), Vec3::UnitZ(), "From the side, ring and suction side up") +
                  picture(scene, bounds, Vec3::UnitZ(), Vec3::UnitY(), "From the suction side, along the axis") +
                  picture(scene, bounds, -Vec3::UnitZ(), Vec3::UnitY(), "From the hub, along the axis");
    } else {
        const postproc::HeadScene scene = scene_of(surface, inspection.soundness);
        const geometry::Bounds& bounds = inspection.soundness.bounds;
        figures = picture(scene, bounds, Vec3(0.6, -1.0, 0.6), Vec3::UnitZ(), "From the side, the file’s z upwards") +
                  picture(scene, bounds, Vec3::UnitZ(), Vec3::UnitY(), "From the file’s +z") +
                  picture(scene, bounds, -Vec3::UnitZ(), Vec3::UnitY(), "From the file’s −z");
    }
    return html::section("The surface", "<div class=\"views\">" + figures + "</div>");
}

std::string contour_section(const geometry::Head& head, const fs::path& folder) {
    const char* const title = "Contour of revolution";
    if (!postproc::gnuplot_is_installed())
        return html::section(title, "<p class=\"notice\">The plot is missing: gnuplot is not installed (package gnuplot-nox).</p>");
    const std::vector<double>&z = head.contour.z, &radius = head.contour.radius;
    const double height = -head.lowest_z, top = 1.08 * *std::max_element(radius.begin(), radius.end());
    postproc::Plot plot;
    plot.name = "contour";
    plot.width = k_plot_width;
    plot.height = 430;
    plot.legend = postproc::Legend::none;
    plot.equal_scales = true;
    plot.x.title = "z along the axis, m (hub left, ring plane z = 0 right)";
    plot.x.from = head.lowest_z - 0.06 * height;
    plot.x.to = 0.06 * height;
    plot.y.title = "r, m";
    plot.y.from = 0.0;
    plot.y.to = top;
    plot.areas.push_back({"steel", "#eef1f4", z, std::vector<double>(z.size(), 0.0), radius});
    postproc::Series ring{"", palette::faint, {0.0, 0.0}, {0.0, top}}, contour{"", palette::flow_load, z, radius};
    ring.line_width = 1.0;
    ring.dashed = true;
    contour.line_width = 2.0;
    plot.series = {ring, contour};
    const fs::path scratch = folder / "plots";
    const std::string svg = postproc::draw_svg(plot, scratch);
    fs::remove_all(scratch);
    return html::section(
        title, html::figure(svg, fmt::format("Largest radius of the steel at each height z; {} nodes, within {:.2g} m of the surface.",
                                             head.contour.z.size(), head.contour.error)));
}

std::string answers(const geometry::GeometryInspection& inspection) {
    const geometry::SoundnessReport& report = inspection.soundness;
    const bool sound = report.sound();
    const std::string comment = !sound            ? fmt::format("{} kind(s) of defect", geometry::defects_of(report, "").size())
                                : inspection.head ? "ready for a study"
                                                  : "but no cutter head";
    std::string boxes = html::answer(sound ? "#00795c" : k_mark_colour, "A sound solid: closed, outward, free of self-intersections?",
                                     sound ? "yes" : "no", comment);
    if (inspection.head) {
        const geometry::Head& head = *inspection.head;
        boxes += html::answer(palette::flow_load, "Ring radius", fmt::format("{:.4g} m", head.ring_radius),
                              fmt::format("head height {:.4g} m", -head.lowest_z));
        boxes += html::answer(palette::flow_load, "Blades", fmt::format("{}", head.symmetry.blade_count),
                              fmt::format("repeat within {:.2g} m (RMS)", head.symmetry.residual));
    } else {
        const Vec3 extent = report.bounds.extent();
        boxes += html::answer(palette::flow_load, "Largest extent", fmt::format("{:.4g} m", extent.maxCoeff()),
                              fmt::format("{:.4g} × {:.4g} × {:.4g} m", extent.x(), extent.y(), extent.z()));
    }
    if (report.closed())
        boxes += html::answer(palette::flow_load, "Volume of steel", fmt::format("{:.4g} m³", report.volume),
                              fmt::format("area {:.4g} m²", report.area));
    return "<div class=\"answers\">" + boxes + "</div>\n";
}

std::string defect_section(const geometry::GeometryInspection& inspection) {
    const std::vector<Mistake> defects = geometry::defects_of(inspection.soundness, "");
    if (defects.empty()) return "";
    std::vector<std::vector<std::string>> rows;
    for (const Mistake& defect : defects)
        rows.push_back({html::escape(defect.what), html::escape(defect.rule), html::escape(defect.remedy)});
    return html::section("Defects", html::table({"what", "rule", "remedy"}, rows, false) +
                                        fmt::format("<p>Red balls in the pictures mark the first places of each kind. To have it repaired: "
                                                    "<code>cutterflow repair {} -o repaired.stl</code></p>",
                                                    html::escape(fs::path(inspection.file).filename().string())));
}

/// Why a sound solid is no head.
std::string no_head_section(const geometry::GeometryInspection& inspection) {
    if (inspection.no_head.empty()) return "";
    std::vector<std::vector<std::string>> rows;
    for (const Mistake& mistake : inspection.no_head)
        rows.push_back({html::escape(mistake.what), html::escape(mistake.rule), html::escape(mistake.remedy)});
    return html::section("Not a cutter head", html::table({"what", "rule", "remedy"}, rows, false));
}

std::string vector_text(const Vec3& v) {
    const Vec3 rounded = (1e4 * v).array().round() / 1e4 + 0.0;  // no "-0"
    return fmt::format("({:g}, {:g}, {:g})", rounded.x(), rounded.y(), rounded.z());
}

std::string numbers_section(const geometry::GeometryInspection& inspection) {
    const geometry::SoundnessReport& r = inspection.soundness;
    const auto row = [](const char* name, const std::string& value) { return std::vector<std::string>{name, value}; };
    const auto yes = [](bool value) { return std::string(value ? "yes" : "no"); };
    const std::string surface =
        html::table({},
                    {row("triangles", fmt::format("{}", r.triangles)), row("points", fmt::format("{}", r.points)),
                     row("components", fmt::format("{}", r.components.size())), row("closed", yes(r.closed())),
                     row("consistently oriented", yes(r.consistently_oriented())),
                     row("crossing pairs of triangles", fmt::format("{}", r.self_intersections.count)),
                     row("bounds from, m", vector_text(r.bounds.min)), row("bounds to, m", vector_text(r.bounds.max))},
                    true);
    std::string content = "<div class=\"tables\"><div><h3>Surface, in the file’s frame</h3>" + surface + "</div>";
    if (inspection.head) {
        const geometry::Head& head = *inspection.head;
        const char* sense = head.carrying.sense == geometry::CarryingSense::none       ? "neither way"
                            : head.carrying.sense == geometry::CarryingSense::positive ? "right-handed"
                                                                                       : "left-handed";
        content +=
            "<div><h3>Head</h3>" +
            html::table(
                {},
                {row("axis through, m", vector_text(head.axis.origin)),
                 row("axis direction, hub to ring", vector_text(head.axis.direction)),
                 row("steel above the ring plane", fmt::format("{:.4g} m", head.steel_above_ring)),
                 row("largest rock that gets between two blades", head.passage ? fmt::format("{:.3g} m", *head.passage) : "–"),
                 row("thinnest steel", fmt::format("{:.3g} m", head.thickness)), row("turns so to carry rock to the suction side", sense),
                 row("measure of carrying (−1 to 1)", fmt::format("{:.3g}", head.carrying.measure)),
                 row("contrast of the symmetry (0 to 1)", fmt::format("{:.3g}", head.symmetry.contrast))},
                true) +
            "</div>";
    }
    return html::section("Numbers", content + "</div>");
}

void require_empty(const fs::path& folder) {
    if (fs::exists(folder) && (!fs::is_directory(folder) || !fs::is_empty(folder)))
        throw UserError(fmt::format("{} is there already and not an empty folder", folder.string()), "Nothing is overwritten",
                        "Choose another folder or remove it");
}

}  // namespace

void write_inspection(const geometry::GeometryInspection& inspection, const geometry::TriangleSurface& surface, const fs::path& folder) {
    require_empty(folder);
    write_file(folder / "inspection.json", geometry::to_json(inspection).dump(2) + "\n");
    const std::string title = html::escape(fs::path(inspection.file).filename().string());
    std::string body =
        fmt::format("<header><h1>{}</h1><p class=\"operating\">{}</p></header>\n", title, html::escape(inspection.unit.reason));
    body += answers(inspection) + defect_section(inspection) + no_head_section(inspection) + pictures(inspection, surface);
    if (inspection.head) body += contour_section(*inspection.head, folder);
    body += numbers_section(inspection);
    write_file(folder / "index.html", html::document(title, body, "The same numbers for programs: inspection.json."));
}

}  // namespace cutterflow::cases
