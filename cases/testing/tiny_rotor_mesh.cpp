#include "cases/testing/tiny_rotor_mesh.hpp"

#include <array>
#include <cmath>
#include <map>
#include <string>

#include "geometry/head/head_names.hpp"
#include "meshing/dictionary/foam_dictionary.hpp"

namespace cutterflow::cases::test {
namespace {

constexpr int k_sectors = 8;
constexpr int k_cells_per_sector = 4;
constexpr int k_cells_axial = 6;
constexpr int k_rings = 6;  // circles of vertices; 2 and 3 coincide: the two sides of the interface
constexpr std::array<double, k_rings> k_radius = {0.1, k_tiny_rotor_radius, 0.2, 0.2, 0.3, k_tiny_tank_radius};

/// Layer of blocks between two circles of vertices.
struct Layer {
    int inner;
    int cells;
    bool rotor;
    const char* top;
};
constexpr std::array<Layer, 4> k_layers = {{{0, 3, true, names::backplate_patch},
                                            {1, 3, true, names::backplate_patch},
                                            {3, 4, false, names::outlet_patch},
                                            {4, 6, false, names::tank_top_patch}}};

bool is_steel(const Layer& layer, int sector) {
    return layer.inner == 0 && sector % (k_sectors / 2) == 0;
}

int vertex(int ring, int sector, int level) {
    return (level * k_rings + ring) * k_sectors + sector % k_sectors;
}

Vec3 point(int ring, double sector, int level) {
    const double angle = 2.0 * k_pi * sector / k_sectors;
    return {k_radius[ring] * std::cos(angle), k_radius[ring] * std::sin(angle), level == 0 ? k_tiny_z_min : k_tiny_z_max};
}

meshing::FoamValue face(std::array<int, 4> corners) {
    return meshing::FoamValue::list({corners[0], corners[1], corners[2], corners[3]});
}

meshing::FoamValue circle_face(int ring, int sector) {
    return face({vertex(ring, sector, 0), vertex(ring, sector + 1, 0), vertex(ring, sector + 1, 1), vertex(ring, sector, 1)});
}

meshing::FoamValue flat_face(int ring, int sector, int level) {
    return face({vertex(ring, sector, level), vertex(ring + 1, sector, level), vertex(ring + 1, sector + 1, level),
                 vertex(ring, sector + 1, level)});
}

meshing::FoamValue radial_face(int ring, int sector) {
    return face({vertex(ring, sector, 0), vertex(ring + 1, sector, 0), vertex(ring + 1, sector, 1), vertex(ring, sector, 1)});
}

meshing::FoamValue block(const Layer& layer, int sector) {
    const int a = layer.inner, b = layer.inner + 1;
    const meshing::FoamValue corners =
        meshing::FoamValue::list({vertex(a, sector, 0), vertex(b, sector, 0), vertex(b, sector + 1, 0), vertex(a, sector + 1, 0),
                                  vertex(a, sector, 1), vertex(b, sector, 1), vertex(b, sector + 1, 1), vertex(a, sector + 1, 1)});
    const meshing::FoamValue cells = meshing::FoamValue::list({layer.cells, k_cells_per_sector, k_cells_axial});
    return meshing::FoamValue::sequence(
        {"hex", corners, layer.rotor ? names::rotor_zone : "stator", cells, "simpleGrading", meshing::FoamValue::list({1, 1, 1})});
}

using PatchFaces = std::map<std::string, std::vector<meshing::FoamValue>>;

void add_faces_of_block(const Layer& layer, int sector, PatchFaces& patches) {
    patches[names::tank_bottom_patch].push_back(flat_face(layer.inner, sector, 0));
    patches[layer.top].push_back(flat_face(layer.inner, sector, 1));
    if (layer.inner == 0) patches[names::cutter_patch].push_back(circle_face(0, sector));
}

void add_faces_of_steel(const Layer& layer, int sector, PatchFaces& patches) {
    auto& cutter = patches[names::cutter_patch];
    cutter.push_back(circle_face(layer.inner + 1, sector));
    cutter.push_back(radial_face(layer.inner, sector));
    cutter.push_back(radial_face(layer.inner, sector + 1));
}

meshing::FoamValue patch(const std::string& name, meshing::FoamDictionary type, const std::vector<meshing::FoamValue>& faces) {
    type.add("faces", meshing::FoamValue::list(faces));
    return meshing::FoamValue::sequence({name, type});
}

meshing::FoamDictionary interface_side(const char* neighbour) {
    return meshing::FoamDictionary().add("type", "cyclicAMI").add("neighbourPatch", neighbour).add("transform", "noOrdering");
}

meshing::FoamValue boundary() {
    PatchFaces patches;
    std::vector<meshing::FoamValue> rotor_side, stator_side;
    for (int sector = 0; sector < k_sectors; ++sector) {
        for (const Layer& layer : k_layers)
            is_steel(layer, sector) ? add_faces_of_steel(layer, sector, patches) : add_faces_of_block(layer, sector, patches);
        patches[names::inlet_patch].push_back(circle_face(k_rings - 1, sector));
        rotor_side.push_back(circle_face(2, sector));
        stator_side.push_back(circle_face(3, sector));
    }
    std::vector<meshing::FoamValue> list;
    for (const auto& [name, faces] : patches) {
        const bool open = name == names::inlet_patch || name == names::outlet_patch;
        list.push_back(patch(name, meshing::FoamDictionary().add("type", open ? "patch" : "wall"), faces));
    }
    list.push_back(patch(names::rotor_interface_patch, interface_side(names::stator_interface_patch), rotor_side));
    list.push_back(patch(names::stator_interface_patch, interface_side(names::rotor_interface_patch), stator_side));
    return meshing::FoamValue::list(list);
}

}  // namespace

void write_tiny_block_mesh(const std::filesystem::path& case_directory) {
    std::vector<meshing::FoamValue> vertices, edges, blocks;
    for (int level = 0; level < 2; ++level) {
        for (int ring = 0; ring < k_rings; ++ring) {
            for (int sector = 0; sector < k_sectors; ++sector) {
                vertices.emplace_back(point(ring, sector, level));
                if (ring == 0 && is_steel(k_layers[0], sector)) continue;
                edges.push_back(meshing::FoamValue::sequence(
                    {"arc", vertex(ring, sector, level), vertex(ring, sector + 1, level), point(ring, sector + 0.5, level)}));
            }
        }
    }
    for (const Layer& layer : k_layers)
        for (int sector = 0; sector < k_sectors; ++sector)
            if (!is_steel(layer, sector)) blocks.push_back(block(layer, sector));

    meshing::FoamDictionary mesh;
    mesh.add("scale", 1)
        .add("vertices", meshing::FoamValue::list(vertices))
        .add("edges", meshing::FoamValue::list(edges))
        .add("blocks", meshing::FoamValue::list(blocks))
        .add("boundary", boundary());
    meshing::write_foam_file(case_directory / "system/blockMeshDict", "dictionary", mesh);
}

CaseInputs tiny_inputs() {
    CaseInputs inputs(geometry::Contour({-0.25, 0.0}, {k_tiny_rotor_radius, k_tiny_rotor_radius}, k_tiny_rotor_radius, 0.02));
    inputs.rotor.speed = rpm_to_rad_s(60.0);
    inputs.discharge = 0.01;
    inputs.gravity = gravity_of(30.0 * k_pi / 180.0);
    inputs.tank = {k_tiny_tank_radius, k_tiny_z_min, k_tiny_z_max};
    inputs.fates.mouth.centre = Vec3(0.25, 0.0, k_tiny_z_max);
    inputs.fates.mouth.radius = 0.05;
    inputs.times.end = 0.1;
    inputs.times.write_interval = 0.1;
    inputs.checkpoint.interval = 0.1;
    inputs.times.first_time_step = 1e-3;
    fill_scaled_defaults(inputs);
    return inputs;
}

}  // namespace cutterflow::cases::test
