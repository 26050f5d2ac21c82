/// The axis, the blades and the carrying sense of 30 tilted, shifted and roughened heads: a table, and exit code 4 when one is missed.
#include <iostream>

#include "geometry/base/error.hpp"
#include "validation/studies/heads/axis_check.hpp"

int main() {
    using namespace cutterflow::validation;
    constexpr int k_heads = 30;
    int passed = 0;
    std::cout << table_header() << std::endl;
    for (int i = 0; i < k_heads; ++i) {
        try {
            const AxisCheck check = check_axis(i);
            passed += check.passed() ? 1 : 0;
            std::cout << table_row(i, check) << std::endl;
        } catch (const cutterflow::Failure& failure) {
            std::cout << i + 1 << " MISSED: " << failure.what() << std::endl;
        }
    }
    std::cout << passed << " of " << k_heads << " within 0.1 degrees and 0.1 % of the radius, blades and carrying sense right\n";
    return passed == k_heads ? 0 : 4;
}
