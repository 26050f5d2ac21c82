#include "cases/scenes/room/bed.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <fmt/format.h>

#include "cases/study/contact_rules.hpp"
#include "geometry/base/mistakes.hpp"

namespace cutterflow::cases {

namespace {

constexpr double k_longest_settling = 20.0;  // [s], where no step says it
constexpr double k_press_speed = 0.05;       // [m/s]
constexpr double k_press_way = 0.3;          // overlaps in a step

class Pieces {
public:
    Pieces(const RoomScene& scene, std::mt19937_64& random) : pouring_(scene, random) {}

    void take(const PrepareStep& step) {
        if (const auto* pour = std::get_if<PourStep>(&step)) {
            mistakes_.gather([&] { pouring_.pour(*pour); });
            open_ = poured_ = true;
        } else if (const auto* trim = std::get_if<TrimStep>(&step)) {
            add({"remove", 0.0, trim->region});
            pouring_.trim(trim->region);
        } else if (const auto* freeze = std::get_if<FreezeStep>(&step)) {
            add({"freeze", 0.0, freeze->region, freeze->where});
        } else if (const auto* compress = std::get_if<CompressStep>(&step)) {
            close(k_longest_settling);
            pieces_.push_back({{}, {}, compress->longest, *compress});
        } else {
            close(std::get<SettleStep>(step).longest);
        }
    }

    std::vector<BedPiece> finish() {
        close(k_longest_settling);
        mistakes_.refuse();
        return std::move(pieces_);
    }

private:
    void add(RegionEvent event) {
        if (poured_) close(k_longest_settling);
        events_.push_back(std::move(event));
        open_ = true;
    }

    void close(double longest) {
        if (!open_) return;
        pieces_.push_back({pouring_.take(), std::move(events_), longest});
        events_.clear();
        open_ = poured_ = false;
    }

    Pouring pouring_;
    std::vector<RegionEvent> events_;
    std::vector<BedPiece> pieces_;
    Mistakes mistakes_;
    bool open_ = false;    // something belongs to the present piece
    bool poured_ = false;  // and its grains move
};

}  // namespace

double BedPiece::end() const {
    return (grains.empty() ? 0.0 : grains.back().time) + longest;
}

std::vector<Mistake> empty_freezes(const BedPiece& piece, std::vector<Vec3> centres) {
    std::vector<Mistake> mistakes;
    for (const RegionEvent& event : piece.events) {
        const auto is_in = [&](const Vec3& centre) { return is_within(event.region, centre); };
        if (event.what == "remove") {
            centres.erase(std::remove_if(centres.begin(), centres.end(), is_in), centres.end());
            continue;
        }
        if (std::any_of(centres.begin(), centres.end(), is_in)) continue;
        Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity()), upper = -lower;
        for (const Vec3& centre : centres) {
            lower = lower.cwiseMin(centre);
            upper = upper.cwiseMax(centre);
        }
        const std::string centres_text =
            centres.empty() ? std::string("the bed has none")
                            : fmt::format("those of its {} lie from ({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, {:.4g}, {:.4g}) m", centres.size(),
                                          lower.x(), lower.y(), lower.z(), upper.x(), upper.y(), upper.z());
        mistakes.push_back({event.where, "do = \"freeze\" finds 0 grains in its region",
                            fmt::format("It freezes the grains whose centres lie in its region, and {}", centres_text),
                            "Correct the region, or remove the step"});
    }
    return mistakes;
}

double contact_step(const RoomScene& scene, const coupling::ContactSettings& contact) {
    if (scene.grains.empty()) return 0.0;
    double step = std::numeric_limits<double>::infinity();
    for (const RoomGrains& kind : scene.grains)
        for (const GrainClass& one : kind.extremes())
            step = std::min(step, kind.shape ? contact_step(contact, *kind.shape, one.diameter, one.density)
                                             : contact_step(contact, one.diameter, one.density));
    return step;
}

double press_speed(const RoomScene& scene, const CompressStep& compress) {
    double thinnest = std::numeric_limits<double>::infinity();
    for (const RoomGrains& kind : scene.grains) {
        const double d = kind.smallest();
        const double modulus = 0.5 * scene.contact.youngs_modulus / (1.0 - scene.contact.poisson_rock * scene.contact.poisson_rock);
        thinnest = std::min(thinnest, std::pow(compress.pressure * d * d / (4.0 / 3.0 * modulus * std::sqrt(0.25 * d)), 2.0 / 3.0));
    }
    return std::min(k_press_speed, k_press_way * thinnest / contact_step(scene, scene.bed_contact()));
}

std::vector<BedPiece> bed_pieces(const RoomScene& scene) {
    std::mt19937_64 random(scene.run.seed);
    Pieces pieces(scene, random);
    for (const PrepareStep& step : scene.preparation) pieces.take(step);
    return pieces.finish();
}

}  // namespace cutterflow::cases
