#pragma once
/// \file A material of rooms' studies in tests.
#include <string>

namespace cutterflow::cases::test {

/// A material "stone" with its contacts, as studies have it.
inline const std::string k_stone = R"([[material]]
name = "stone"
youngs_modulus_pa = 1e7
[[contact]]
pair = ["stone", "stone"]
friction = 0.5
restitution = 0.8
[[contact]]
pair = ["stone", "steel"]
friction = 0.4
restitution = 0.8
)";

}  // namespace cutterflow::cases::test
