#include "meshing/cutter/background_mesh.hpp"

#include <array>
#include <cmath>
#include <map>

#include "geometry/base/axis_frame.hpp"
#include "geometry/head/head_names.hpp"

namespace cutterflow::meshing {
namespace {

constexpr int k_sides = 4;
using Corners = std::array<std::size_t, k_sides>;

/// The rings of block corners at one height, from inside out: core, annulus' inner radius, interface, tank. Rings that no block uses stay
/// unset.
struct Level {
    Corners core{}, inner{}, interface { }, tank{}; };

/// Vertices, arcs, blocks and patches as blockMesh reads them.
class Blocks {
public:
    /// Four corners at the diagonals on radius `radius`, joined by arcs through `side_radius` at the axes.
    Corners ring(double z, double radius, double side_radius) {
        Corners corners{};
        for (int side = 0; side < k_sides; ++side) {
            corners[side] = vertices_.size();
            vertices_.push_back(point(radius, diagonal(side), z));
        }
        for (int side = 0; side < k_sides; ++side)
            arcs_.push_back(FoamValue::sequence(
                {"arc", corners[side], corners[next(side)], point(side_radius, 0.5 * (diagonal(side) + diagonal(side + 1)), z)}));
        return corners;
    }

    void core_block(const Level& low, const Level& high, int cells, const CellRow& height, const char* zone) {
        add_block({low.core[0], low.core[1], low.core[2], low.core[3], high.core[0], high.core[1], high.core[2], high.core[3]},
                  {cells, cells, height.cells}, {1.0, 1.0, height.expansion}, zone);
    }

    /// The four blocks between two rings.
    void ring_blocks(const Corners& low_inner, const Corners& low_outer, const Corners& high_inner, const Corners& high_outer,
                     const CellRow& radius, int azimuthal_cells, const CellRow& height, const char* zone) {
        for (int side = 0; side < k_sides; ++side) {
            const int n = next(side);
            add_block({low_inner[side], low_outer[side], low_outer[n], low_inner[n], high_inner[side], high_outer[side], high_outer[n],
                       high_inner[n]},
                      {radius.cells, azimuthal_cells, height.cells}, {radius.expansion, 1.0, height.expansion}, zone);
        }
    }

    /// Faces between two rings of one height, or between the same ring at two heights.
    void patch_strip(const char* patch, const Corners& a, const Corners& b) {
        for (int side = 0; side < k_sides; ++side) add_face(patch, {a[side], a[next(side)], b[next(side)], b[side]});
    }

    void patch_square(const char* patch, const Corners& corners) { add_face(patch, corners); }

    FoamDictionary dictionary() const {
        FoamDictionary result;
        result.add("scale", 1);
        result.add("vertices", FoamValue::list(vertices_));
        result.add("edges", FoamValue::list(arcs_));
        result.add("blocks", FoamValue::list(blocks_));
        std::vector<FoamValue> patches;
        for (const auto& [name, faces] : patches_) {
            FoamDictionary patch;
            const bool wall = name == names::tank_top_patch || name == names::tank_bottom_patch;
            patch.add("type", wall ? "wall" : "patch").add("faces", FoamValue::list(faces));
            patches.push_back(FoamValue::sequence({name, patch}));
        }
        result.add("boundary", FoamValue::list(patches));
        result.add("mergePatchPairs", FoamValue::list({}));
        return result;
    }

private:
    static int next(int side) { return (side + 1) % k_sides; }
    static double diagonal(int side) { return 0.25 * k_pi + 0.5 * k_pi * side; }
    static Vec3 point(double radius, double azimuth, double z) { return {radius * std::cos(azimuth), radius * std::sin(azimuth), z}; }

    void add_block(const std::array<std::size_t, 8>& corners, const std::array<int, 3>& cells, const std::array<double, 3>& expansion,
                   const char* zone) {
        blocks_.push_back(FoamValue::sequence(
            {"hex", FoamValue::list_of(corners), zone, FoamValue::list_of(cells), "simpleGrading", FoamValue::list_of(expansion)}));
    }

    void add_face(const char* patch, const Corners& corners) { patches_[patch].push_back(FoamValue::list_of(corners)); }

    std::vector<FoamValue> vertices_, arcs_, blocks_;
    std::map<std::string, std::vector<FoamValue>> patches_;
};

/// Builds one body of revolution, layer by layer; rotor and stator are two of them without common points.
class Body {
public:
    Body(Blocks& blocks, const MeshPlan& plan, const char* zone) : blocks_(blocks), plan_(plan), zone_(zone) {}

    /// A level with all rings up to the interface.
    Level disc_level(double z) {
        Level level;
        level.core = blocks_.ring(z, plan_.core_radius, plan_.core_side_radius);
        level.inner = circle(z, plan_.annulus.from);
        level.interface = circle(z, plan_.rotor.radius);
        return level;
    }

    Corners circle(double z, double radius) { return blocks_.ring(z, radius, radius); }

    void fill_disc(const Level& low, const Level& high, const CellRow& height) {
        const CellRow transition{plan_.core_radius, plan_.annulus.from, plan_.transition_cells, 1.0};
        blocks_.core_block(low, high, plan_.core_cells(), height, zone_);
        blocks_.ring_blocks(low.core, low.inner, high.core, high.inner, transition, plan_.core_cells(), height, zone_);
        blocks_.ring_blocks(low.inner, low.interface, high.inner, high.interface, plan_.annulus, plan_.core_cells(), height, zone_);
    }

    void fill_outside(const Level& low, const Level& high, const CellRow& height) {
        blocks_.ring_blocks(low.interface, low.tank, high.interface, high.tank, plan_.outer, plan_.core_cells(), height, zone_);
    }

    void patch_disc(const char* patch, const Level& level) {
        blocks_.patch_square(patch, level.core);
        blocks_.patch_strip(patch, level.core, level.inner);
        blocks_.patch_strip(patch, level.inner, level.interface);
    }

private:
    Blocks& blocks_;
    const MeshPlan& plan_;
    const char* zone_;
};

void add_rotor(Blocks& blocks, const MeshPlan& plan) {
    Body body(blocks, plan, names::rotor_zone);
    Level low = body.disc_level(plan.rotor.z_bottom);
    body.patch_disc(k_rotor_side_patch, low);
    for (const CellRow& row : plan.zone) {
        const Level high = body.disc_level(row.to);
        body.fill_disc(low, high, row);
        blocks.patch_strip(k_rotor_side_patch, low.interface, high.interface);
        low = high;
    }
    body.patch_disc(k_rotor_side_patch, low);
}

void add_stator(Blocks& blocks, const MeshPlan& plan) {
    Body body(blocks, plan, k_stator_zone);
    const auto level_at = [&](double z, bool disc) {
        Level level;
        if (disc)
            level = body.disc_level(z);
        else
            level.interface = body.circle(z, plan.rotor.radius);
        level.tank = body.circle(z, plan.input.tank.radius);
        return level;
    };
    const auto layer = [&](const Level& low, const Level& high, const CellRow& row) {
        body.fill_outside(low, high, row);
        blocks.patch_strip(names::inlet_patch, low.tank, high.tank);
    };

    Level low = level_at(plan.input.tank.z_min, true);
    body.patch_disc(names::tank_bottom_patch, low);
    blocks.patch_strip(names::tank_bottom_patch, low.interface, low.tank);
    for (const CellRow& row : plan.below) {
        const Level high = level_at(row.to, true);
        layer(low, high, row);
        body.fill_disc(low, high, row);
        low = high;
    }
    body.patch_disc(k_stator_side_patch, low);
    for (const CellRow& row : plan.zone) {
        const Level high = level_at(row.to, &row == &plan.zone.back());
        layer(low, high, row);
        blocks.patch_strip(k_stator_side_patch, low.interface, high.interface);
        low = high;
    }
    body.patch_disc(k_stator_side_patch, low);
    for (const CellRow& row : plan.above) {
        const Level high = level_at(row.to, true);
        layer(low, high, row);
        body.fill_disc(low, high, row);
        low = high;
    }
    body.patch_disc(names::tank_top_patch, low);
    blocks.patch_strip(names::tank_top_patch, low.interface, low.tank);
}

}  // namespace

FoamDictionary background_mesh(const MeshPlan& plan) {
    Blocks blocks;
    add_rotor(blocks, plan);
    add_stator(blocks, plan);
    return blocks.dictionary();
}

}  // namespace cutterflow::meshing
