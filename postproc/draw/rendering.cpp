#include "postproc/draw/rendering.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <Eigen/Geometry>

#include "geometry/base/axis_frame.hpp"
#include "postproc/draw/painted_surface.hpp"

namespace cutterflow::postproc {
namespace {

constexpr int k_supersampling = 2;
constexpr double k_ghost_opacity = 0.16, k_soil_opacity = 0.45;
constexpr double k_crease_cosine = 0.85;  ///< sharper turns are edges
const Colour k_steel{0.76, 0.79, 0.82};
const Colour k_ghost{0.45, 0.55, 0.65};
const Colour k_soil{0.72, 0.58, 0.38};

/// Small, because a picture has millions of them.
struct Sample {
    float depth = -std::numeric_limits<float>::infinity();  ///< towards the viewer [m]
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();       ///< in the picture's frame
    std::uint32_t colour = 0;                               ///< index into the layer's colours
};

class Layer {
public:
    explicit Layer(const View& view) : view_(view), samples_(static_cast<std::size_t>(view.width) * view.height) {}

    /// \param normals  at the corners, on the side of the triangle's own
    void draw(const Triangle& triangle, const std::array<Vec3, 3>& normals, const Colour& colour);
    void draw(const Sphere& sphere);
    const Colour& colour_at(int x, int y) const { return colours_[at(x, y).colour]; }
    const Sample& at(int x, int y) const { return samples_[static_cast<std::size_t>(y) * view_.width + x]; }

private:
    void put(int x, int y, double depth, const Vec3& normal, std::uint32_t colour) {
        Sample& sample = samples_[static_cast<std::size_t>(y) * view_.width + x];
        if (static_cast<float>(depth) > sample.depth) sample = {static_cast<float>(depth), normal.cast<float>(), colour};
    }
    std::uint32_t index_of(const Colour& colour);
    Vec3 in_picture(const Vec3& vector) const { return {vector.dot(view_.right), vector.dot(view_.up), vector.dot(view_.towards)}; }

    const View& view_;
    std::vector<Sample> samples_;
    std::vector<Colour> colours_{Colour{}};
};

std::uint32_t Layer::index_of(const Colour& colour) {
    const auto same = [&](const Colour& c) { return c.red == colour.red && c.green == colour.green && c.blue == colour.blue; };
    const auto found = std::find_if(colours_.begin(), colours_.end(), same);
    if (found != colours_.end()) return static_cast<std::uint32_t>(found - colours_.begin());
    colours_.push_back(colour);
    return static_cast<std::uint32_t>(colours_.size() - 1);
}

/// Pixels whose centres lie between two coordinates, clipped to the picture.
std::pair<int, int> pixel_range(double low, double high, int size) {
    return {std::clamp(static_cast<int>(std::ceil(low - 0.5)), 0, size), std::clamp(static_cast<int>(std::floor(high - 0.5)) + 1, 0, size)};
}

/// Normal of a triangle, as long as twice its area.
Vec3 area_normal(const Triangle& triangle) {
    return (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
}

/// Normals at the corners of every triangle: mean over the triangles that meet there without a crease, so that curved steel looks curved.
std::vector<std::array<Vec3, 3>> corner_normals(const TriangleSurface& surface) {
    const auto key = [](const Vec3& point) {
        return std::array<long, 3>{std::lround(1e6 * point.x()), std::lround(1e6 * point.y()), std::lround(1e6 * point.z())};
    };
    std::map<std::array<long, 3>, std::vector<std::size_t>> triangles_at;
    for (std::size_t i = 0; i < surface.size(); ++i) {
        for (const Vec3& corner : surface[i]) triangles_at[key(corner)].push_back(i);
    }
    std::vector<std::array<Vec3, 3>> normals(surface.size());
    for (std::size_t i = 0; i < surface.size(); ++i) {
        const Vec3 own = area_normal(surface[i]).normalized();
        for (std::size_t corner = 0; corner < 3; ++corner) {
            Vec3 sum = Vec3::Zero();
            for (const std::size_t neighbour : triangles_at[key(surface[i][corner])]) {
                const Vec3 normal = area_normal(surface[neighbour]);
                if (normal.dot(own) > k_crease_cosine * normal.norm()) sum += normal;
            }
            normals[i][corner] = sum.norm() > 0.0 ? Vec3(sum.normalized()) : own;
        }
    }
    return normals;
}

void Layer::draw(const Triangle& triangle, const std::array<Vec3, 3>& normals, const Colour& colour) {
    const Vec3 a = view_.project(triangle[0]), b = view_.project(triangle[1]), c = view_.project(triangle[2]);
    const double area = (b.x() - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (b.y() - a.y());
    if (area == 0.0) return;
    const std::uint32_t index = index_of(colour);
    const double side = area_normal(triangle).dot(view_.towards) < 0.0 ? -1.0 : 1.0;
    const std::array<Vec3, 3> seen{side * in_picture(normals[0]), side * in_picture(normals[1]), side * in_picture(normals[2])};
    const auto [x_first, x_last] = pixel_range(std::min({a.x(), b.x(), c.x()}), std::max({a.x(), b.x(), c.x()}), view_.width);
    const auto [y_first, y_last] = pixel_range(std::min({a.y(), b.y(), c.y()}), std::max({a.y(), b.y(), c.y()}), view_.height);
    for (int y = y_first; y < y_last; ++y) {
        for (int x = x_first; x < x_last; ++x) {
            const double px = x + 0.5, py = y + 0.5;
            const double wb = ((px - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (py - a.y())) / area;
            const double wc = ((b.x() - a.x()) * (py - a.y()) - (px - a.x()) * (b.y() - a.y())) / area;
            if (wb < 0.0 || wc < 0.0 || wb + wc > 1.0) continue;
            const Vec3 normal = ((1.0 - wb - wc) * seen[0] + wb * seen[1] + wc * seen[2]).normalized();
            put(x, y, a.z() + wb * (b.z() - a.z()) + wc * (c.z() - a.z()), normal, index);
        }
    }
}

void Layer::draw(const Sphere& sphere) {
    const std::uint32_t index = index_of(sphere.colour);
    const Vec3 centre = view_.project(sphere.centre);
    const double pixels_per_m = view_.height / view_.height_m;
    const double radius = sphere.radius * pixels_per_m;
    const auto [x_first, x_last] = pixel_range(centre.x() - radius, centre.x() + radius, view_.width);
    const auto [y_first, y_last] = pixel_range(centre.y() - radius, centre.y() + radius, view_.height);
    for (int y = y_first; y < y_last; ++y) {
        for (int x = x_first; x < x_last; ++x) {
            const double dx = (x + 0.5 - centre.x()) / radius, dy = (centre.y() - y - 0.5) / radius;
            const double rest = 1.0 - dx * dx - dy * dy;
            if (rest < 0.0) continue;
            const double dz = std::sqrt(rest);
            put(x, y, centre.z() + dz * sphere.radius, {dx, dy, dz}, index);
        }
    }
}

Colour operator*(double factor, const Colour& c) {
    return {factor * c.red, factor * c.green, factor * c.blue};
}
Colour operator+(const Colour& a, const Colour& b) {
    return {a.red + b.red, a.green + b.green, a.blue + b.blue};
}
Colour mix(const Colour& a, const Colour& b, double share_of_b) {
    return (1.0 - share_of_b) * a + share_of_b * b;
}

/// Key light from the upper left, fill light from the right, a soft highlight.
Colour shade(const Layer& layer, int x, int y) {
    static const Vec3 key = Vec3(-0.45, 0.65, 0.62).normalized();
    static const Vec3 fill = Vec3(0.8, -0.1, 0.6).normalized();
    static const Vec3 half = (key + Vec3::UnitZ()).normalized();
    const Vec3 normal = layer.at(x, y).normal.cast<double>();
    const double diffuse = 0.42 + 0.56 * std::max(0.0, normal.dot(key)) + 0.18 * std::max(0.0, normal.dot(fill));
    const double highlight = 0.20 * std::pow(std::max(0.0, normal.dot(half)), 24.0);
    return diffuse * layer.colour_at(x, y) + Colour{highlight, highlight, highlight};
}

/// Edges of bodies and creases: 0 none, 1 full. `step` [m] is the jump in depth that makes an edge.
double edge_strength(const Layer& layer, const View& view, int x, int y, double step) {
    const Sample& here = layer.at(x, y);
    double strength = 0.0;
    for (const auto& [dx, dy] : {std::pair{1, 0}, std::pair{0, 1}, std::pair{-1, 0}, std::pair{0, -1}}) {
        const int nx = x + dx, ny = y + dy;
        if (nx < 0 || ny < 0 || nx >= view.width || ny >= view.height) continue;
        const Sample& there = layer.at(nx, ny);
        if (std::isinf(here.depth) && std::isinf(there.depth)) continue;
        // Only the nearer side of a jump is darkened, so that lines stay thin.
        if (here.depth - there.depth > step) strength = std::max(strength, 0.75);
        if (!std::isinf(there.depth) && here.normal.dot(there.normal) < 0.75F) strength = std::max(strength, 0.45);
    }
    return strength;
}

/// Colour of one sample of the finished picture.
Colour composite(const Layer& solids, const Layer& soil, const Layer& ghosts, const View& view, int x, int y) {
    const Colour white{1.0, 1.0, 1.0}, ink{0.13, 0.16, 0.20};
    const double step = 12.0 * view.height_m / view.height;
    const Sample& solid = solids.at(x, y);
    Colour colour = white;
    if (!std::isinf(solid.depth)) colour = mix(shade(solids, x, y), ink, edge_strength(solids, view, x, y, step));
    const Sample& earth = soil.at(x, y);
    if (earth.depth > solid.depth)
        colour = mix(colour, mix(shade(soil, x, y), ink, 0.5 * edge_strength(soil, view, x, y, step)), k_soil_opacity);
    const Sample& ghost = ghosts.at(x, y);
    if (ghost.depth > solid.depth) {
        colour = mix(colour, shade(ghosts, x, y), k_ghost_opacity);
        colour = mix(colour, k_ghost, 0.6 * edge_strength(ghosts, view, x, y, step));
    }
    return colour;
}

/// \param colours  of the triangles
void draw_surface(Layer& layer, const TriangleSurface& surface, const std::vector<Colour>& colours) {
    const std::vector<std::array<Vec3, 3>> normals = corner_normals(surface);
    for (std::size_t i = 0; i < surface.size(); ++i) layer.draw(surface[i], normals[i], colours[i]);
}

void draw_surface(Layer& layer, const TriangleSurface& surface, const Colour& colour) {
    draw_surface(layer, surface, std::vector<Colour>(surface.size(), colour));
}

TriangleSurface turned(TriangleSurface surface, double angle) {
    for (Triangle& triangle : surface) {
        for (Vec3& corner : triangle) corner = rotate_about({}, angle, corner);
    }
    return surface;
}

std::uint8_t to_byte(double value) {
    return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(value, 0.0, 1.0)));
}

}  // namespace

Vec3 View::project(const Vec3& point) const {
    const Vec3 arm = point - centre;
    const double pixels_per_m = height / height_m;
    return {0.5 * width + pixels_per_m * arm.dot(right), 0.5 * height - pixels_per_m * arm.dot(up), arm.dot(towards)};
}

Image render(const HeadScene& scene, const View& view) {
    return render_painted(scene, std::vector<Colour>(scene.steel.size(), k_steel), view);
}

Image render_painted(const HeadScene& scene, const std::vector<Colour>& colours, const View& view) {
    View fine = view;
    fine.width *= k_supersampling;
    fine.height *= k_supersampling;
    Layer solids(fine), soil(fine), ghosts(fine);
    draw_surface(solids, turned(scene.steel, scene.steel_angle), colours);
    for (const Sphere& rock : scene.rocks) solids.draw(rock);
    draw_surface(soil, scene.soil, k_soil);
    draw_surface(ghosts, scene.ghosts, k_ghost);
    Image image{view.width, view.height, {}};
    image.rgb.reserve(3 * static_cast<std::size_t>(view.width) * view.height);
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            Colour sum;
            for (int i = 0; i < k_supersampling * k_supersampling; ++i) {
                sum = sum + composite(solids, soil, ghosts, fine, k_supersampling * x + i % k_supersampling,
                                      k_supersampling * y + i / k_supersampling);
            }
            const Colour mean = (1.0 / (k_supersampling * k_supersampling)) * sum;
            for (const double part : {mean.red, mean.green, mean.blue}) image.rgb.push_back(to_byte(part));
        }
    }
    return image;
}

}  // namespace cutterflow::postproc
