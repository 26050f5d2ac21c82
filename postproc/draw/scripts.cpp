#include "postproc/draw/scripts.hpp"

#include <array>
#include <stdexcept>
#include <string_view>

#include <zlib.h>

// The assembler copies the files into the program: no generated source, no limit of a string literal.
#define CUTTERFLOW_TAKE_IN(name, file)                                            \
    __asm__(                                                                      \
        ".pushsection .rodata\n"                                                  \
        "cutterflow_" #name "_begin: .incbin \"" CUTTERFLOW_POSTPROC_DIR "/" file \
        "\"\n"                                                                    \
        "cutterflow_" #name                                                       \
        "_end:\n"                                                                 \
        ".popsection\n");                                                         \
    extern "C" const char cutterflow_##name##_begin[], cutterflow_##name##_end[]

CUTTERFLOW_TAKE_IN(plotly, "third_party/plotly-cartesian.min.js.gz");
CUTTERFLOW_TAKE_IN(three, "third_party/three.min.js.gz");
CUTTERFLOW_TAKE_IN(page, "draw/page.js");

namespace cutterflow::postproc::scripts {
namespace {

std::string_view between(const char* begin, const char* end) {
    return {begin, static_cast<std::size_t>(end - begin)};
}

std::string unpacked(std::string_view gzip) {
    z_stream stream{};
    if (inflateInit2(&stream, 16 + MAX_WBITS) != Z_OK) throw std::runtime_error("zlib cannot begin");  // 16: a gzip header
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(gzip.data()));
    stream.avail_in = static_cast<uInt>(gzip.size());
    std::string text;
    std::array<char, 65536> part{};
    int code = Z_OK;
    while (code == Z_OK) {
        stream.next_out = reinterpret_cast<Bytef*>(part.data());
        stream.avail_out = static_cast<uInt>(part.size());
        code = inflate(&stream, Z_NO_FLUSH);
        text.append(part.data(), part.size() - stream.avail_out);
    }
    inflateEnd(&stream);
    if (code != Z_STREAM_END) throw std::runtime_error("a script in the program is broken");
    return text;
}

}  // namespace

std::string plotly() {
    return unpacked(between(cutterflow_plotly_begin, cutterflow_plotly_end));
}

std::string three() {
    return unpacked(between(cutterflow_three_begin, cutterflow_three_end));
}

std::string page() {
    return std::string(between(cutterflow_page_begin, cutterflow_page_end));
}

}  // namespace cutterflow::postproc::scripts
