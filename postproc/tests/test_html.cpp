#include <gtest/gtest.h>

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

}  // namespace
}  // namespace cutterflow::postproc
