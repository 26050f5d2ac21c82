#pragma once
/// \file Makes our contact models known to LIGGGHTS.

namespace cutterflow::liggghts {

/// The words by which LIGGGHTS' commands select our models.
inline constexpr const char* k_contact_model = "model rock";

/// Registers the pair model and the walls with LIGGGHTS' factories. Cheap to repeat.
void register_contact_models();

}  // namespace cutterflow::liggghts
