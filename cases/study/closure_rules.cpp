#include "cases/study/closure_rules.hpp"

#include <fmt/format.h>

#include "solver/physics/catalogue.hpp"
#include "solver/ports/mapping_width.hpp"

namespace cutterflow::cases {
namespace {

/// In the study, or of the drag law where the hindrance is its default.
std::string place_of_hindrance(const ParameterValues& values) {
    return values.where(values.where("closures.hindrance").empty() ? "closures.drag" : "closures.hindrance");
}

}  // namespace

std::vector<Mistake> closure_mistakes(const ParameterValues& values) {
    const std::string &drag = values.text("closures.drag"), &hindrance = values.text("closures.hindrance");
    if (!physics::drag_law_holds_void_fraction(drag) || hindrance == physics::k_no_closure) return {};
    return {{place_of_hindrance(values), fmt::format("closures.hindrance = \"{}\"", hindrance),
             fmt::format("closures.drag = \"{}\" holds the void fraction itself: hindrance would count it twice", drag),
             "Set closures.hindrance = \"none\""}};
}

std::vector<Mistake> hindrance_warnings(const ParameterValues& values, bool dense) {
    const std::string& hindrance = values.text("closures.hindrance");
    const double modifier = values.number("closures.drag_modifier");
    const bool hindered = hindrance != physics::k_no_closure || physics::drag_law_holds_void_fraction(values.text("closures.drag"));
    if (hindered && modifier != 1.0)
        return {{values.where("closures.drag_modifier"), fmt::format("closures.drag_modifier = {:g}", modifier),
                 "The hindrance by other rock is in the drag already; a modifier that was fitted without it counts it twice",
                 "Set it to 1, or closures.hindrance = \"none\""}};
    if (!hindered && modifier == 1.0 && dense)
        return {{place_of_hindrance(values), fmt::format("closures.hindrance = \"{}\"", hindrance),
                 fmt::format("Rock starts with a solid fraction above {:g}, where the drag of a single rock is too small", k_dilute_solids),
                 "Choose a hindrance"}};
    return {};
}

std::optional<Mistake> wide_kernel_warning(const Opening& opening, const coupling::KernelSettings& kernel, double diameter) {
    // Kernel widths from which on a rock that samples from a shell sees the speed at a mouth to a tenth; near by it does from one width on
    // (case mouth). What it takes of room and momentum is spread over a kernel all the same.
    const bool near = kernel.sampling == coupling::k_gaussian_sampling;
    const double resolved_by = near ? 4.0 : 7.0;
    if (kernel.map != coupling::k_gaussian_map) return std::nullopt;
    const double width = coupling::mapping_width(kernel, diameter, opening.cell);
    if (opening.width >= resolved_by * width) return std::nullopt;
    const bool by_cells = width > kernel.gamma * diameter;
    const std::string of = by_cells ? fmt::format("in cells of {:.2g} m", opening.cell) : fmt::format("of rock of {:g} m", diameter);
    const std::string other = by_cells ? "smaller cells" : "kernel.gamma = 0.5";
    return Mistake{opening.where, fmt::format("{} = {:.6g}", opening.name, opening.width),
                   fmt::format("It is {:.2g} times the kernel width {}; below {:g} times {}", opening.width / width, of, resolved_by,
                               near ? "the room and the momentum that rock takes from the water there are spread past the opening"
                                    : "the speed that rock feels there is off by more than a tenth"),
                   near ? "Compare with " + other : "Set kernel.sampling = \"gaussian\", and compare with " + other};
}

}  // namespace cutterflow::cases
