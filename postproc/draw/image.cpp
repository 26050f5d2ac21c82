#include "postproc/draw/image.hpp"

#include <array>
#include <stdexcept>

#include <zlib.h>

namespace cutterflow::postproc {
namespace {

void append_big_endian(std::string& bytes, std::uint32_t value) {
    for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>((value >> shift) & 0xffU);
}

void append_chunk(std::string& png, const std::string& type, const std::string& data) {
    append_big_endian(png, static_cast<std::uint32_t>(data.size()));
    const std::string body = type + data;
    png += body;
    append_big_endian(png,
                      static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()))));
}

/// Rows with PNG's filter "sub" (difference to the pixel at the left), which packs shaded areas well.
std::string filtered_rows(const Image& image) {
    std::string rows;
    const std::size_t stride = 3 * static_cast<std::size_t>(image.width);
    rows.reserve((stride + 1) * static_cast<std::size_t>(image.height));
    for (std::size_t y = 0; y < static_cast<std::size_t>(image.height); ++y) {
        rows += '\1';
        const std::uint8_t* row = image.rgb.data() + y * stride;
        for (std::size_t i = 0; i < stride; ++i) rows += static_cast<char>(row[i] - (i < 3 ? 0 : row[i - 3]));
    }
    return rows;
}

std::string deflated(const std::string& data) {
    uLongf size = compressBound(static_cast<uLong>(data.size()));
    std::string packed(size, '\0');
    const int code = compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(data.data()),
                               static_cast<uLong>(data.size()), Z_BEST_COMPRESSION);
    if (code != Z_OK) throw std::runtime_error("zlib could not compress a picture");
    packed.resize(size);
    return packed;
}

}  // namespace

Colour colour_of(const std::string& hex) {
    const auto part = [&](std::size_t at) { return std::stoi(hex.substr(at, 2), nullptr, 16) / 255.0; };
    return {part(1), part(3), part(5)};
}

std::string png_bytes(const Image& image) {
    std::string header;
    append_big_endian(header, static_cast<std::uint32_t>(image.width));
    append_big_endian(header, static_cast<std::uint32_t>(image.height));
    header += std::string("\x08\x02\x00\x00\x00", 5);  // 8 bits, RGB, no interlace
    std::string png("\x89PNG\r\n\x1a\n", 8);
    append_chunk(png, "IHDR", header);
    append_chunk(png, "IDAT", deflated(filtered_rows(image)));
    append_chunk(png, "IEND", "");
    return png;
}

std::string base64(const std::string& bytes) {
    static const char* alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            group = (group << 8) | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text += i + k <= bytes.size() ? alphabet[(group >> (18 - 6 * k)) & 63U] : '=';
        }
    }
    return text;
}

}  // namespace cutterflow::postproc
