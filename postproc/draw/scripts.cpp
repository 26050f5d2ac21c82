#include "postproc/draw/scripts.hpp"

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

CUTTERFLOW_TAKE_IN(plotly, "third_party/plotly-cartesian.min.js");
CUTTERFLOW_TAKE_IN(three, "third_party/three.min.js");
CUTTERFLOW_TAKE_IN(page, "draw/page.js");

namespace cutterflow::postproc::scripts {
namespace {

std::string_view between(const char* begin, const char* end) {
    return {begin, static_cast<std::size_t>(end - begin)};
}

}  // namespace

std::string_view plotly() {
    return between(cutterflow_plotly_begin, cutterflow_plotly_end);
}

std::string_view three() {
    return between(cutterflow_three_begin, cutterflow_three_end);
}

std::string_view page() {
    return between(cutterflow_page_begin, cutterflow_page_end);
}

}  // namespace cutterflow::postproc::scripts
