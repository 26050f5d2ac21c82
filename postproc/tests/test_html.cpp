#include <gtest/gtest.h>

#include "postproc/draw/gnuplot.hpp"
#include "postproc/draw/html.hpp"

namespace cutterflow::postproc {
namespace {

TEST(Html, text_cannot_become_markup) {
    EXPECT_EQ(html::escape("<script>alert(\"a\" & 'b')</script>"), "&lt;script&gt;alert(&quot;a&quot; &amp; &#39;b&#39;)&lt;/script&gt;");
}

TEST(Html, first_cell_of_a_row_is_its_heading) {
    const std::string table = html::table({"a", "b"}, {{"x", "1"}}, true);
    EXPECT_NE(table.find("<th scope=\"row\">x</th><td>1</td>"), std::string::npos);
    EXPECT_NE(table.find("<th scope=\"col\">b</th>"), std::string::npos);
}

TEST(Gnuplot, quoted_text_cannot_end_its_string) {
    EXPECT_EQ(quoted("a\"; system \"rm\\"), "\"a\\\"; system \\\"rm\\\\\"");
    EXPECT_EQ(quoted("two\nlines"), "\"two lines\"");
}

TEST(Gnuplot, data_block_has_a_line_per_row) {
    EXPECT_EQ(data_block("d", {{"1", "2"}, {"3"}}), "$d << END_OF_DATA\n1 2\n3\nEND_OF_DATA\n");
}

}  // namespace
}  // namespace cutterflow::postproc
