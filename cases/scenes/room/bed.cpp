#include "cases/scenes/room/bed.hpp"

#include <random>

#include "geometry/base/mistakes.hpp"

namespace cutterflow::cases {

namespace {

constexpr double k_longest_settling = 20.0;  // [s], where no step says it

class Pieces {
public:
    Pieces(const RoomScene& scene, std::mt19937_64& random) : pouring_(scene, random) {}

    void take(const PrepareStep& step) {
        if (const auto* pour = std::get_if<PourStep>(&step)) {
            mistakes_.gather([&] { pouring_.pour(*pour); });
            open_ = poured_ = true;
        } else if (const auto* trim = std::get_if<TrimStep>(&step)) {
            add("remove", trim->region);
        } else if (const auto* freeze = std::get_if<FreezeStep>(&step)) {
            add("freeze", freeze->region);
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
    void add(const char* what, const Region& region) {
        if (poured_) close(k_longest_settling);
        events_.push_back({what, 0.0, region});
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

std::vector<BedPiece> bed_pieces(const RoomScene& scene) {
    std::mt19937_64 random(scene.run.seed);
    Pieces pieces(scene, random);
    for (const PrepareStep& step : scene.preparation) pieces.take(step);
    return pieces.finish();
}

}  // namespace cutterflow::cases
