#pragma once
/// \file Colours of the report: one per fate and quantity, everywhere the same; told apart with any colour vision (after Okabe and Ito) and
/// by lightness in print.

namespace cutterflow::postproc::palette {

inline constexpr const char* sucked_up = "#0072b2";
inline constexpr const char* spilled = "#d55e00";
inline constexpr const char* in_cutter = "#f0c14b";
inline constexpr const char* never_entered = "#9aa3ab";
inline constexpr const char* outflow = "#00795c";
inline constexpr const char* flow_load = "#3b5b76";
inline constexpr const char* rock_load = "#a34b86";
inline constexpr const char* ink = "#26303a";
inline constexpr const char* faint = "#8a94a0";
inline constexpr const char* soil = "#b89461";

/// Of a field, light to dark, the same in print; no darker, because arrows lie over it.
inline constexpr const char* field[] = {"#f4f8fb", "#cfe3f1", "#93c4e4", "#4f9fd1", "#0072b2"};

}  // namespace cutterflow::postproc::palette
