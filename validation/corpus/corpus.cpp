#include "validation/corpus/corpus.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/installation.hpp"
#include "geometry/cgal/exact_solid.hpp"
#include "geometry/head/crown_cutter.hpp"
#include "geometry/surface/revolve.hpp"
#include "validation/corpus/damage.hpp"

namespace cutterflow::validation {
namespace {

constexpr double k_per_millimetre = 1e3;
constexpr double k_per_inch = 1.0 / 0.0254;

// ---- formats ----

template <class Value>
void append_bytes(std::string& bytes, const Value& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string binary_stl(const geometry::TriangleSurface& surface, double per_metre = 1.0) {
    std::string bytes(80, ' ');
    append_bytes(bytes, static_cast<std::uint32_t>(surface.triangles.size()));
    for (const geometry::Triangle& t : surface.triangles) {
        bytes.append(12, '\0');
        for (const std::uint32_t corner : t)
            for (int k = 0; k < 3; ++k) append_bytes(bytes, static_cast<float>(per_metre * surface.points[corner][k]));
        bytes.append(2, '\0');
    }
    return bytes;
}

std::string ascii_stl(const geometry::TriangleSurface& surface, double per_metre = 1.0) {
    std::string text = "solid head\n";
    for (const geometry::Triangle& t : surface.triangles) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (const std::uint32_t corner : t) {
            const Vec3 p = per_metre * surface.points[corner];
            text += fmt::format("vertex {:.7g} {:.7g} {:.7g}\n", p.x(), p.y(), p.z());
        }
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid head\n";
}

std::string obj(const geometry::TriangleSurface& surface, double per_metre = 1.0) {
    std::string text;
    for (const Vec3& p : surface.points)
        text += fmt::format("v {:.8g} {:.8g} {:.8g}\n", per_metre * p.x(), per_metre * p.y(), per_metre * p.z());
    for (const geometry::Triangle& t : surface.triangles) text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
    return text;
}

std::string ply_head(const geometry::TriangleSurface& surface, const std::string& format) {
    return fmt::format(
        "ply\nformat {} 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\nelement face {}\n"
        "property list uchar int vertex_indices\nend_header\n",
        format, surface.points.size(), surface.triangles.size());
}

std::string ascii_ply(const geometry::TriangleSurface& surface, double per_metre = 1.0) {
    std::string text = ply_head(surface, "ascii");
    for (const Vec3& p : surface.points)
        text += fmt::format("{:.8g} {:.8g} {:.8g}\n", per_metre * p.x(), per_metre * p.y(), per_metre * p.z());
    for (const geometry::Triangle& t : surface.triangles) text += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
    return text;
}

std::string binary_ply(const geometry::TriangleSurface& surface) {
    std::string bytes = ply_head(surface, "binary_little_endian");
    for (const Vec3& p : surface.points)
        for (int k = 0; k < 3; ++k) append_bytes(bytes, static_cast<float>(p[k]));
    for (const geometry::Triangle& t : surface.triangles) {
        bytes += '\3';
        for (const std::uint32_t corner : t) append_bytes(bytes, corner);
    }
    return bytes;
}

// ---- solids ----

const geometry::CrownParameters& crown_parameters() {
    static const geometry::CrownParameters parameters =
        geometry::read_crown_parameters(installation().data / "cases/examples/model_cutter/crown.toml");
    return parameters;
}

const geometry::TriangleSurface& crown() {
    static const geometry::TriangleSurface surface = geometry::generate_crown_cutter(crown_parameters());
    return surface;
}

/// Hub, ring and blades as CAD programs export assemblies: closed shells that reach into each other.
const std::vector<geometry::TriangleSurface>& crown_parts() {
    static const std::vector<geometry::TriangleSurface> parts = [] {
        const geometry::CrownParameters& p = crown_parameters();
        const double edge = p.edge_length;
        std::vector<geometry::TriangleSurface> all{
            geometry::solid_of_revolution(
                {{p.ring_inner_radius, -p.ring_height}, {p.ring_radius, -p.ring_height}, {p.ring_radius, 0.0}, {p.ring_inner_radius, 0.0}},
                geometry::circle_segments(p.ring_radius, edge), edge),
            geometry::solid_of_revolution({{0.0, p.hub_height - p.hub_depth},
                                           {p.hub_radius, p.hub_height - p.hub_depth},
                                           {p.hub_radius, -p.hub_depth},
                                           {0.0, -p.hub_depth}},
                                          geometry::circle_segments(p.hub_radius, edge), edge)};
        const geometry::TriangleSurface blade = geometry::crown_blade(p);
        for (int i = 0; i < p.blade_count; ++i)
            all.push_back(geometry::transformed(blade, Eigen::Affine3d(Eigen::AngleAxisd(2.0 * k_pi * i / p.blade_count, Vec3::UnitZ()))));
        return all;
    }();
    return parts;
}

double united_volume(const std::vector<geometry::TriangleSurface>& parts) {
    geometry::ExactSolid solid(parts.front());
    for (std::size_t i = 1; i < parts.size(); ++i) solid.unite(geometry::ExactSolid(parts[i]));
    return geometry::volume_of(solid.surface());
}

/// The solids that every kind of damage is tried on.
struct Base {
    std::string name;
    geometry::TriangleSurface surface;
};

const std::vector<Base>& bases() {
    static const std::vector<Base> all{{"crown", crown()},
                                       {"ball", ball(0.5, 5)},
                                       {"block", block(Vec3(-0.5, -0.4, -0.3), Vec3(0.5, 0.4, 0.3), 24)},
                                       {"torus", ring_torus(0.4, 0.12, 72, 28)}};
    return all;
}

/// A kind of damage that every solid survives.
struct Damage {
    std::string name;
    std::function<geometry::TriangleSurface(const geometry::TriangleSurface&)> apply;
};

geometry::TriangleSurface with_everything(const geometry::TriangleSurface& surface) {
    geometry::TriangleSurface s = with_flipped_triangles(surface, surface.triangles.size() / 10, Dice(51));
    s = with_missing_triangles(s, 4, Dice(52));
    s = with_t_junctions(s, 8, Dice(53));
    s = with_flat_triangles(s, 5, Dice(54));
    s = with_fins(s, 3, Dice(55));
    s = with_duplicates(s, 20, true, Dice(56));
    s = with_duplicates(s, 20, false, Dice(57));
    return torn_apart(s, 1e-6, Dice(58));
}

const std::vector<Damage>& damages() {
    static const std::vector<Damage> all{
        {"one_triangle_missing", [](const geometry::TriangleSurface& s) { return with_missing_triangles(s, 1, Dice(1)); }},
        {"ten_triangles_missing", [](const geometry::TriangleSurface& s) { return with_missing_triangles(s, 10, Dice(2)); }},
        {"disc_missing", [](const geometry::TriangleSurface& s) { return with_missing_disc(s, 0.018, Dice(3)); }},
        {"one_flipped", [](const geometry::TriangleSurface& s) { return with_flipped_triangles(s, 1, Dice(4)); }},
        {"fifth_flipped", [](const geometry::TriangleSurface& s) { return with_flipped_triangles(s, s.triangles.size() / 5, Dice(5)); }},
        {"inside_out", [](const geometry::TriangleSurface& s) { return inside_out(s); }},
        {"duplicates", [](const geometry::TriangleSurface& s) { return with_duplicates(s, s.triangles.size() / 20, false, Dice(6)); }},
        {"flipped_duplicates",
         [](const geometry::TriangleSurface& s) { return with_duplicates(s, s.triangles.size() / 20, true, Dice(7)); }},
        {"t_junctions", [](const geometry::TriangleSurface& s) { return with_t_junctions(s, 40, Dice(8)); }},
        {"flat_triangles", [](const geometry::TriangleSurface& s) { return with_flat_triangles(s, 30, Dice(9)); }},
        {"slivers", [](const geometry::TriangleSurface& s) { return with_slivers(s, 30, Dice(10)); }},
        {"torn_apart", [](const geometry::TriangleSurface& s) { return torn_apart(s, 2e-6, Dice(11)); }},
        {"folds", [](const geometry::TriangleSurface& s) { return with_folds(s, 3, Dice(12)); }},
        {"fins", [](const geometry::TriangleSurface& s) { return with_fins(s, 5, Dice(13)); }},
        {"everything", [](const geometry::TriangleSurface& s) { return with_everything(s); }},
    };
    return all;
}

class Corpus {
public:
    std::vector<DamagedFile> files;

    /// A surface that must be repaired.
    void repaired(const std::string& name, double volume, std::function<std::string()> content, std::vector<std::string> options = {}) {
        files.push_back({name, std::move(content), volume, "", std::move(options)});
    }
    void refused(const std::string& name, const std::string& words, std::function<std::string()> content,
                 std::vector<std::string> options = {}) {
        files.push_back({name, std::move(content), 0.0, words, std::move(options)});
    }
};

void add_damaged_solids(Corpus& corpus) {
    for (const Damage& damage : damages())
        for (const Base& base : bases())
            corpus.repaired(base.name + "_" + damage.name + ".stl", geometry::volume_of(base.surface),
                            [&base, &damage] { return binary_stl(damage.apply(base.surface)); });
}

/// Three to five kinds of damage one after the other, drawn by lot; torn apart at last, if at all.
geometry::TriangleSurface randomly_damaged(geometry::TriangleSurface s, std::uint32_t seed) {
    Dice dice(seed);
    const std::size_t kinds = 3 + dice.below(3);
    for (std::size_t k = 0; k < kinds; ++k) {
        const Dice own(1000 * seed + static_cast<std::uint32_t>(k));
        const std::size_t some = 1 + dice.below(15);
        switch (dice.below(9)) {
            case 0:
                s = with_missing_triangles(s, std::min<std::size_t>(some, 8), own);
                break;
            case 1:
                s = with_flipped_triangles(s, 20 * some, own);
                break;
            case 2:
                s = with_duplicates(s, 10 * some, false, own);
                break;
            case 3:
                s = with_duplicates(s, 10 * some, true, own);
                break;
            case 4:
                s = with_t_junctions(s, some, own);
                break;
            case 5:
                s = with_flat_triangles(s, some, own);
                break;
            case 6:
                s = with_slivers(s, some, own);
                break;
            case 7:
                s = with_fins(s, some, own);
                break;
            default:
                s = with_folds(s, 1 + some / 5, own);
                break;
        }
    }
    return dice.below(2) == 0 ? s : torn_apart(s, 1e-6, Dice(seed));
}

void add_random_combinations(Corpus& corpus) {
    for (std::uint32_t seed = 1; seed <= 24; ++seed) {
        const Base& base = bases()[seed % bases().size()];
        corpus.repaired(fmt::format("combination_{:02}_{}.stl", seed, base.name), geometry::volume_of(base.surface),
                        [&base, seed] { return binary_stl(randomly_damaged(base.surface, seed)); });
    }
}

void add_shells(Corpus& corpus) {
    const geometry::TriangleSurface a = block(Vec3(-0.5, -0.5, -0.5), Vec3(0.1, 0.5, 0.5), 4);
    const auto stl_of = [](std::vector<geometry::TriangleSurface> parts) {
        return [parts = std::move(parts)] { return binary_stl(geometry::joined(parts)); };
    };

    corpus.repaired("crown_in_eight_shells.stl", united_volume(crown_parts()), stl_of(crown_parts()));
    std::vector<geometry::TriangleSurface> parts = crown_parts();
    parts[3] = inside_out(parts[3]);
    parts[0] = with_flipped_triangles(parts[0], 20, Dice(20));
    parts[5] = with_missing_triangles(parts[5], 2, Dice(21));
    corpus.repaired("crown_in_eight_damaged_shells.stl", united_volume(crown_parts()), stl_of(parts));
    corpus.repaired("crown_twice.stl", geometry::volume_of(crown()), stl_of({crown(), crown()}));
    corpus.repaired("crown_twice_once_inside_out.stl", geometry::volume_of(crown()), stl_of({crown(), inside_out(crown())}));

    const geometry::TriangleSurface b = block(Vec3(-0.1, -0.3, -0.2), Vec3(0.5, 0.4, 0.3), 3);
    corpus.repaired("overlapping_blocks.stl", united_volume({a, b}), stl_of({a, b}));
    corpus.repaired("overlapping_blocks_one_inside_out.stl", united_volume({a, b}), stl_of({a, inside_out(b)}));
    // Flush: four faces of the two lie in the same planes and overlap.
    const geometry::TriangleSurface flush = block(Vec3(-0.1, -0.5, -0.5), Vec3(0.5, 0.5, 0.5), 3);
    corpus.repaired("flush_overlapping_blocks.stl", 1.0, stl_of({a, flush}));
    const geometry::TriangleSurface beside = block(Vec3(0.1, -0.5, -0.5), Vec3(0.5, 0.5, 0.5), 4);
    corpus.repaired("blocks_that_share_a_face.stl", 1.0, stl_of({a, beside}));
    const geometry::TriangleSurface smaller_beside = block(Vec3(0.1, -0.3, -0.2), Vec3(0.5, 0.25, 0.35), 3);
    corpus.repaired("block_standing_on_a_face.stl", 0.6 + 0.4 * 0.55 * 0.55, stl_of({a, smaller_beside}));
    const geometry::TriangleSurface tilted =
        geometry::transformed(b, Eigen::Affine3d(Eigen::AngleAxisd(0.3, Vec3(1.0, 2.0, 0.5).normalized())));
    corpus.repaired("tilted_overlapping_blocks.stl", united_volume({a, tilted}), stl_of({a, tilted}));
    corpus.repaired("block_within_block.stl", 0.6, stl_of({a, block(Vec3(-0.4, -0.4, -0.4), Vec3(0.0, 0.2, 0.3), 3)}));
    const geometry::TriangleSurface left = moved(ball(0.3, 3), Vec3(-0.2, 0, 0)), right = moved(ball(0.3, 3), Vec3(0.2, 0.01, 0.003)),
                                    top = moved(ball(0.3, 3), Vec3(0.004, 0.02, 0.25));
    corpus.repaired("three_balls.stl", united_volume({left, right, top}), stl_of({left, right, top}));
    corpus.repaired("three_balls_torn_apart.stl", united_volume({left, right, top}), [=] {
        return binary_stl(torn_apart(geometry::joined({left, right, top}), 1e-6, Dice(22)));
    });
    const geometry::TriangleSurface ring = ring_torus(0.4, 0.1, 60, 24),
                                    link = geometry::transformed(moved(ring_torus(0.4, 0.1, 60, 24), Vec3(0.25, 0, 0)),
                                                                 Eigen::Affine3d(Eigen::AngleAxisd(1.1, Vec3::UnitX())));
    corpus.repaired("two_tori.stl", united_volume({ring, link}), stl_of({ring, link}));
    corpus.repaired("ball_with_inner_wall.stl", geometry::volume_of(ball(0.5, 4)),
                    [] { return binary_stl(with_inner_wall(ball(0.5, 4), equator(ball(0.5, 4)))); });
    corpus.repaired("ball_with_small_cavity.stl", geometry::volume_of(ball(0.5, 4)),
                    stl_of({ball(0.5, 4), inside_out(moved(ball(0.05, 2), Vec3(0.1, 0.1, 0.1)))}));
    corpus.refused("ball_with_large_cavity.stl", "closed cavities", stl_of({ball(0.5, 4), inside_out(ball(0.3, 3))}));
    corpus.refused("blocks_that_touch_along_an_edge.stl", "edge(s) with more than two triangles",
                   stl_of({block(Vec3(0, 0, 0), Vec3(0.5, 0.5, 0.5), 3), block(Vec3(0.5, 0.5, 0), Vec3(1, 1, 0.5), 3)}));
    corpus.repaired("blocks_that_touch_at_a_point.stl", 0.25,
                    stl_of({block(Vec3(0, 0, 0), Vec3(0.5, 0.5, 0.5), 3), block(Vec3(0.5, 0.5, 0.5), Vec3(1, 1, 1), 3)}));
}

void add_open_surfaces(Corpus& corpus) {
    corpus.refused("half_ball.stl", "a hole of", [] {
        geometry::TriangleSurface half = ball(0.5, 4);
        geometry::TriangleSurface upper{half.points, {}};
        for (const geometry::Triangle& t : half.triangles)
            if (geometry::centroid_of(half, t).z() > 0.0) upper.triangles.push_back(t);
        return binary_stl(upper);
    });
    corpus.refused("block_without_lid.stl", "a hole of", [] {
        geometry::TriangleSurface open = block(Vec3(0, 0, 0), Vec3(1, 1, 0.5), 1);
        open.triangles.resize(open.triangles.size() - 2);
        return binary_stl(open);
    });
    corpus.repaired("block_without_lid_filled_on_demand.stl", 0.5,
                    [] {
                        geometry::TriangleSurface open = block(Vec3(0, 0, 0), Vec3(1, 1, 0.5), 1);
                        open.triangles.resize(open.triangles.size() - 2);
                        return binary_stl(open);
                    },
                    {"--hole-size-m", "1.5", "--area-change-percent", "40", "--volume-change-percent", "60"});
    corpus.refused("many_holes.stl", "the patches of all holes",
                   [] { return binary_stl(with_missing_triangles(ball(0.5, 5), 250, Dice(30))); });
    corpus.refused("large_disc_missing.stl", "a hole of", [] { return binary_stl(with_missing_disc(crown(), 0.06, Dice(31))); });
    corpus.refused("one_triangle.stl", "a hole of", [] {
        return binary_stl({{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {{0, 1, 2}}});
    });
    corpus.refused("flat_sheet.obj", "a hole of", [] {
        geometry::TriangleSurface sheet{{}, {}};
        const geometry::TriangleSurface cube = block(Vec3(0, 0, 0), Vec3(1, 1, 1), 5);
        sheet.points = cube.points;
        for (const geometry::Triangle& t : cube.triangles)
            if (geometry::centroid_of(cube, t).z() == 0.0) sheet.triangles.push_back(t);
        return obj(sheet);
    });
    corpus.refused("moebius_band.stl", "one side only", [] { return binary_stl(moebius_band(0.4, 0.2, 60)); });
    corpus.refused("klein_bottle.stl", "one side only", [] { return binary_stl(klein_bottle(0.5, 0.15, 60, 31)); });
    corpus.refused("all_triangles_flat.stl", "nothing is left", [] {
        return binary_stl({{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 0, 0), Vec3(0.2, 0, 0)}, {{0, 1, 2}, {0, 2, 3}}});
    });
    corpus.refused("random_triangles.stl", "a hole of", [] {
        Dice dice(32);
        geometry::TriangleSurface soup;
        for (std::uint32_t t = 0; t < 3000; ++t) {
            for (int k = 0; k < 3; ++k) {
                const double x = dice.between(-1, 1), y = dice.between(-1, 1), z = dice.between(-1, 1);
                soup.points.emplace_back(x, y, z);
            }
            soup.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
        }
        return binary_stl(soup);
    });
}

void add_wide_cracks_and_spikes(Corpus& corpus) {
    // Wider than the weld distance: every triangle is its own hole, and some few have met neighbours.
    corpus.refused("crown_cracks_of_a_tenth_of_a_millimetre.stl", "a hole of",
                   [] { return binary_stl(torn_apart(crown(), 1e-4, Dice(60))); });
    // One point pulled through the far side: a thin cone that crosses it.
    corpus.repaired("ball_with_a_spike_through_it.stl", geometry::volume_of(ball(0.5, 5)), [] {
        geometry::TriangleSurface spiked = ball(0.5, 5);
        spiked.points[100] = -1.2 * spiked.points[100];
        return binary_stl(spiked);
    });
}

void add_formats_and_units(Corpus& corpus) {
    const auto damaged_crown = [] { return with_flipped_triangles(with_missing_triangles(crown(), 3, Dice(40)), 100, Dice(41)); };
    const double volume = geometry::volume_of(crown());
    corpus.repaired("millimetres_binary.stl", volume, [=] { return binary_stl(damaged_crown(), k_per_millimetre); });
    corpus.repaired("millimetres_ascii.STL", volume, [=] { return ascii_stl(damaged_crown(), k_per_millimetre); });
    corpus.repaired("inches_ascii.stl", volume, [=] { return ascii_stl(damaged_crown(), k_per_inch); });
    corpus.repaired("inches_binary.stl", volume, [=] { return binary_stl(damaged_crown(), k_per_inch); });
    corpus.repaired("centimetres_said.stl", volume, [=] { return binary_stl(damaged_crown(), 100.0); }, {"--unit", "cm"});
    corpus.repaired("metres_ascii.stl", volume, [=] { return ascii_stl(damaged_crown()); });
    corpus.repaired("millimetres.obj", volume, [=] { return obj(damaged_crown(), k_per_millimetre); });
    corpus.repaired("ascii.ply", volume, [=] { return ascii_ply(damaged_crown()); });
    corpus.repaired("inches.ply", volume, [=] { return ascii_ply(damaged_crown(), k_per_inch); });
    corpus.repaired("binary.ply", volume, [=] { return binary_ply(damaged_crown()); });
    corpus.repaired("far_from_origin_in_millimetres.stl", volume,
                    [=] { return binary_stl(moved(damaged_crown(), Vec3(20.0, -35.0, 8.0)), k_per_millimetre); });
    corpus.refused("millimetres_taken_as_metres.stl", "--unit mm", [=] { return binary_stl(damaged_crown(), k_per_millimetre); },
                   {"--unit", "m"});
    corpus.refused("tiny.stl", "fits none of m, mm and inch", [] { return binary_stl(ball(1e-4, 2)); });
}

void add_broken_files(Corpus& corpus) {
    const auto cut = [](std::string bytes, double share) {
        bytes.resize(static_cast<std::size_t>(share * static_cast<double>(bytes.size())));
        return bytes;
    };
    corpus.refused("empty.stl", "the file is empty", [] { return std::string(); });
    corpus.refused("head_alone.stl", "this is no STL", [] { return std::string(40, ' '); });
    corpus.refused("no_triangles.stl", "", [] { return binary_stl({}); });
    corpus.refused("truncated_binary.stl", "truncated", [=] { return cut(binary_stl(crown()), 0.6); });
    corpus.refused("truncated_ascii.stl", "truncated", [=] { return cut(ascii_stl(ball(0.5, 2)), 0.6); });
    corpus.refused("truncated_ascii.ply", "truncated", [=] { return cut(ascii_ply(ball(0.5, 2)), 0.7); });
    corpus.refused("truncated_binary.ply", "truncated", [=] { return cut(binary_ply(ball(0.5, 2)), 0.7); });
    corpus.refused("truncated.obj", "", [=] { return cut(obj(ball(0.5, 2)), 0.2); });
    corpus.refused("no_number.stl", "finite", [] {
        geometry::TriangleSurface surface = ball(0.5, 2);
        surface.points[7].y() = std::numeric_limits<double>::quiet_NaN();
        return binary_stl(surface);
    });
    corpus.refused("infinite_ascii.stl", "finite", [] {
        geometry::TriangleSurface surface = ball(0.5, 2);
        surface.points[7].y() = std::numeric_limits<double>::infinity();
        return ascii_stl(surface);
    });
    corpus.refused("no_number_ascii.ply", "", [] {
        geometry::TriangleSurface surface = ball(0.5, 2);
        surface.points[7].y() = std::numeric_limits<double>::quiet_NaN();
        return ascii_ply(surface);
    });
    corpus.refused("huge_coordinates.stl", "half the surface's largest extent", [] { return binary_stl(ball(1e30, 2)); });
    corpus.refused("announces_four_billion_triangles.stl", "announces 4294967295 triangles", [] {
        std::string bytes = binary_stl(ball(0.5, 1));
        std::memset(&bytes[80], 0xff, 4);
        return bytes;
    });
    corpus.refused("a_letter.stl", "no STL",
                   [] { return std::string("Dear colleague,\nplease find the head attached.\n").append(100, '.'); });
    corpus.refused("indices_out_of_range.obj", "", [] { return std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99\n"); });
    corpus.repaired("large_ball_damaged.stl", geometry::volume_of(ball(0.5, 7)),
                    [] { return binary_stl(with_flipped_triangles(with_missing_triangles(ball(0.5, 7), 20, Dice(42)), 5000, Dice(43))); });
    corpus.repaired("large_ball_torn_apart.stl", geometry::volume_of(ball(0.5, 7)),
                    [] { return binary_stl(torn_apart(ball(0.5, 7), 5e-7, Dice(44))); });
}

}  // namespace

std::vector<DamagedFile> damaged_files() {
    Corpus corpus;
    add_damaged_solids(corpus);
    add_random_combinations(corpus);
    add_shells(corpus);
    add_open_surfaces(corpus);
    add_wide_cracks_and_spikes(corpus);
    add_formats_and_units(corpus);
    add_broken_files(corpus);
    return std::move(corpus.files);
}

}  // namespace cutterflow::validation
