#pragma once
/// \file An RGB image and its forms inside a page.
#include <cstdint>
#include <string>
#include <vector>

namespace cutterflow::postproc {

struct Colour {
    double red = 0.0, green = 0.0, blue = 0.0;  ///< 0 to 1
};

/// Colour of "#rrggbb".
Colour colour_of(const std::string& hex);

struct Image {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;  ///< 3 width height, rows from the top
};

/// PNG file of an image.
std::string png_bytes(const Image& image);

std::string base64(const std::string& bytes);

}  // namespace cutterflow::postproc
