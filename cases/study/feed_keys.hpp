#pragma once
/// \file Which keys of a [[feed]] its kind and its size law use.
#include <string>
#include <utility>
#include <vector>

#include "geometry/base/error.hpp"
#include "geometry/base/parameters/parameter.hpp"

namespace cutterflow::cases {

/// Values of feed.kind and feed.size_law.
inline constexpr const char *k_batch = "batch", *k_cut_face = "cut_face";
inline constexpr const char *k_classes = "classes", *k_rosin_rammler = "rosin_rammler", *k_log_normal = "log_normal";

/// Keys of a feed that say something of another kind of feed or of another size law, each with its mistake; a default says nothing. Some
/// have rules of their own: count, mass_kg, duration_s and size_law. \param table  of the study
std::vector<std::pair<std::string, Mistake>> keys_in_vain(const ParameterValues& feed, const ParameterTable& table);

}  // namespace cutterflow::cases
