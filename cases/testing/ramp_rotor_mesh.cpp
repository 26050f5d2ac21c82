#include "cases/testing/ramp_rotor_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include <fmt/format.h>

#include "cases/testing/tiny_rotor_mesh.hpp"
#include "geometry/base/axis_frame.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/head/head_names.hpp"

namespace cutterflow::cases::test {
namespace {

constexpr int k_sectors = 8;
constexpr double k_sector_deg = 360.0 / k_sectors;
constexpr int k_rings = 6;   // circles of vertices; 2 and 3 coincide: the two sides of the interface
constexpr int k_levels = 3;  // bottom, ramp, top
constexpr std::array<double, k_rings> k_radius = {k_ramp_hub_radius, k_ramp_radius, 0.24, 0.24, 0.34, k_tiny_tank_radius};

/// Layer of blocks between two circles of vertices.
struct RampLayer {
    int inner;
    bool rotor;
    const char* top;
    int cells_radial;
    int cells_axial[k_levels - 1];  ///< below the ramp's height and above
};
constexpr std::array<RampLayer, 4> k_layers = {{{0, true, names::backplate_patch, 8, {6, 6}},
                                                {1, true, names::backplate_patch, 4, {6, 6}},
                                                {3, false, names::outlet_patch, 4, {5, 3}},
                                                {4, false, names::tank_top_patch, 6, {5, 3}}}};

bool is_below_ramp(int sector) {
    return sector * k_sector_deg >= k_ramp_from_deg && (sector + 1) * k_sector_deg <= k_ramp_to_deg;
}

bool is_ramp(int layer_inner, int sector, int level) {
    return layer_inner == 0 && level == 0 && is_below_ramp(sector);
}

/// Those that face the ramp are a quarter of the rock long at most, where the rock is.
int cells_around(const RampLayer& layer, int sector) {
    if (!layer.rotor) return 8;
    return is_below_ramp(sector) ? 15 : 6;
}

double height(int ring, int sector, int level) {
    if (level != 1) return level == 0 ? k_tiny_z_min : k_tiny_z_max;
    const double gap = ring <= 1 ? ramp_gap(k_sector_deg * (sector % k_sectors)) : k_ramp_wide;
    return k_tiny_z_max - gap * k_ramp_rock;
}

std::string point(int ring, double sector, double z) {
    const double azimuth = k_sector_deg * sector * k_pi / 180.0;
    return fmt::format("({:.12g} {:.12g} {:.12g})", k_radius[ring] * std::cos(azimuth), k_radius[ring] * std::sin(azimuth), z);
}

int vertex(int ring, int sector, int level) {
    return (level * k_rings + ring) * k_sectors + sector % k_sectors;
}

std::string face(std::array<int, 4> corners) {
    return fmt::format("({} {} {} {})", corners[0], corners[1], corners[2], corners[3]);
}

std::string circle_face(int ring, int sector, int level) {
    return face({vertex(ring, sector, level), vertex(ring, sector + 1, level), vertex(ring, sector + 1, level + 1),
                 vertex(ring, sector, level + 1)});
}

std::string flat_face(int ring, int sector, int level) {
    return face({vertex(ring, sector, level), vertex(ring + 1, sector, level), vertex(ring + 1, sector + 1, level),
                 vertex(ring, sector + 1, level)});
}

std::string radial_face(int ring, int sector, int level) {
    return face({vertex(ring, sector, level), vertex(ring + 1, sector, level), vertex(ring + 1, sector, level + 1),
                 vertex(ring, sector, level + 1)});
}

std::string block(const RampLayer& layer, int sector, int level) {
    const int a = layer.inner, b = layer.inner + 1, s = sector, t = sector + 1, up = level + 1;
    return fmt::format("hex ({} {} {} {} {} {} {} {}) {} ({} {} {}) simpleGrading (1 1 1)\n", vertex(a, s, level), vertex(b, s, level),
                       vertex(b, t, level), vertex(a, t, level), vertex(a, s, up), vertex(b, s, up), vertex(b, t, up), vertex(a, t, up),
                       layer.rotor ? names::rotor_zone : "stator", layer.cells_radial, cells_around(layer, sector),
                       layer.cells_axial[level]);
}

using PatchFaces = std::map<std::string, std::string>;

void add_faces_of_block(const RampLayer& layer, int sector, int level, PatchFaces& patches) {
    if (level == 0) patches[names::tank_bottom_patch] += flat_face(layer.inner, sector, 0);
    if (level == k_levels - 2) patches[layer.top] += flat_face(layer.inner, sector, k_levels - 1);
    if (layer.inner == 0) patches[names::cutter_patch] += circle_face(0, sector, level);
    if (layer.inner == k_rings - 2) patches[names::inlet_patch] += circle_face(k_rings - 1, sector, level);
}

/// Its upper face, its outer one, and the upright ones at its ends.
void add_faces_of_ramp(int sector, PatchFaces& patches) {
    std::string& cutter = patches[names::cutter_patch];
    cutter += flat_face(0, sector, 1) + circle_face(1, sector, 0);
    if (!is_below_ramp(sector - 1)) cutter += radial_face(0, sector, 0);
    if (!is_below_ramp(sector + 1)) cutter += radial_face(0, sector + 1, 0);
}

std::string interface_side(const char* patch, const char* neighbour, const std::string& faces) {
    return fmt::format("{} {{ type cyclicAMI; neighbourPatch {}; transform noOrdering; faces ({}); }}\n", patch, neighbour, faces);
}

std::string boundary() {
    PatchFaces patches;
    std::string rotor_side, stator_side;
    for (int level = 0; level + 1 < k_levels; ++level)
        for (int sector = 0; sector < k_sectors; ++sector) {
            for (const RampLayer& layer : k_layers)
                is_ramp(layer.inner, sector, level) ? add_faces_of_ramp(sector, patches)
                                                    : add_faces_of_block(layer, sector, level, patches);
            rotor_side += circle_face(2, sector, level);
            stator_side += circle_face(3, sector, level);
        }
    std::string text;
    for (const auto& [name, faces] : patches) {
        const bool open = name == names::inlet_patch || name == names::outlet_patch;
        text += fmt::format("{} {{ type {}; faces ({}); }}\n", name, open ? "patch" : "wall", faces);
    }
    return text + interface_side(names::rotor_interface_patch, names::stator_interface_patch, rotor_side) +
           interface_side(names::stator_interface_patch, names::rotor_interface_patch, stator_side);
}

}  // namespace

double ramp_gap(double azimuth_deg) {
    if (azimuth_deg < k_ramp_from_deg) return k_ramp_wide;
    const double share = (azimuth_deg - k_ramp_from_deg) / (k_ramp_to_deg - k_ramp_from_deg);
    return k_ramp_narrow + (k_ramp_wide - k_ramp_narrow) * std::min(1.0, share);
}

void write_ramp_block_mesh(const std::filesystem::path& case_directory) {
    std::string vertices, edges, blocks;
    for (int level = 0; level < k_levels; ++level)
        for (int ring = 0; ring < k_rings; ++ring)
            for (int sector = 0; sector < k_sectors; ++sector) {
                const double z = height(ring, sector, level), next = height(ring, sector + 1, level);
                vertices += point(ring, sector, z) + "\n";
                if (ring == 0 && level == 0 && is_below_ramp(sector)) continue;  // inside the steel
                edges += fmt::format("arc {} {} {}\n", vertex(ring, sector, level), vertex(ring, sector + 1, level),
                                     point(ring, sector + 0.5, 0.5 * (z + next)));
            }
    for (const RampLayer& layer : k_layers)
        for (int level = 0; level + 1 < k_levels; ++level)
            for (int sector = 0; sector < k_sectors; ++sector)
                if (!is_ramp(layer.inner, sector, level)) blocks += block(layer, sector, level);

    write_file(case_directory / "system/blockMeshDict",
               fmt::format("FoamFile {{ version 2.0; format ascii; class dictionary; object blockMeshDict; }}\nscale 1;\nvertices\n({});\n"
                           "edges\n({});\nblocks\n({});\nboundary\n({});\n",
                           vertices, edges, blocks, boundary()));
}

}  // namespace cutterflow::cases::test
