#include "geometry/base/profiles/profile.hpp"

#include <utility>

#include <fmt/format.h>

#include "geometry/base/csv_table.hpp"
#include "geometry/base/error.hpp"

namespace cutterflow {

Profile read_profile(const std::filesystem::path& file) {
    std::vector<Mistake> mistakes;
    const CsvTable table(file, {"x_m", "height_m"}, {}, mistakes);
    if (!table.has("x_m") || !table.has("height_m")) throw UserError(std::move(mistakes));
    Profile profile;
    for (std::size_t n = 0; n < table.rows(); ++n) {
        const double place = table.at(n, "x_m");
        if (!profile.place.empty() && place <= profile.place.back())
            mistakes.push_back({table.where(n), fmt::format("x_m = {:g} after {:g}", place, profile.place.back()),
                                "Places of a profile increase", "Sort the rows, and keep one of each place"});
        profile.place.push_back(place);
        profile.height.push_back(table.at(n, "height_m"));
    }
    if (mistakes.empty() && table.rows() < 2)
        mistakes.push_back(
            {file.string(), fmt::format("the profile has {} line(s)", table.rows()), "A profile has two or more places", "Add the others"});
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
    return profile;
}

}  // namespace cutterflow
