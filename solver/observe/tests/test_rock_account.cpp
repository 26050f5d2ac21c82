// The account of rock by id: every way in which an engine can lie is caught and named.
#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/base/error.hpp"
#include "geometry/base/sphere.hpp"
#include "solver/observe/rock_account.hpp"

namespace cutterflow::coupling {
namespace {

using ::testing::HasSubstr;

/// Rocks of ids 3, 5, 8.
Rocks three() {
    Rocks rocks;
    for (const int id : {3, 5, 8}) rocks.append({id, Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), 0.01 * id, 2650.0});
    return rocks;
}

RockAccount account_of(const Rocks& rocks) {
    RockAccount account;
    account.place(rocks, std::array<std::size_t, 3>{2, 0, 1});
    return account;
}

Rocks without(const Rocks& rocks, std::size_t gone) {
    Rocks rest;
    for (std::size_t p = 0; p < rocks.size(); ++p)
        if (p != gone) rest.append(rocks, p);
    return rest;
}

std::string complaint(const RockAccount& account, const Rocks& rocks) {
    try {
        account.require(rocks, 0.5);
    } catch (const CheckFailure& failure) {
        return failure.what();
    }
    return "";
}

TEST(RockAccount, holds_what_is_there_and_what_went) {
    const Rocks rocks = three();
    RockAccount account = account_of(rocks);
    EXPECT_EQ(complaint(account, rocks), "");
    EXPECT_EQ(account.order_of(8), 0);
    EXPECT_EQ(account.order_of(5), 2);
    account.take_out(5, Whereabouts::extracted);
    EXPECT_EQ(complaint(account, without(rocks, 1)), "");
    const AccountTotals totals = account.totals();
    EXPECT_EQ(totals.count[0], 2);
    EXPECT_EQ(totals.count[static_cast<std::size_t>(Whereabouts::extracted)], 1);
    EXPECT_EQ(totals.mass[static_cast<std::size_t>(Whereabouts::extracted)], sphere_mass(0.05, 2650.0));
    EXPECT_NEAR(totals.mass[0], sphere_mass(0.03, 2650.0) + sphere_mass(0.08, 2650.0), 1e-12);
}

TEST(RockAccount, names_rock_that_is_missing_returned_doubled_or_changed) {
    const Rocks rocks = three();
    RockAccount account = account_of(rocks);
    for (const std::size_t p : {0, 1, 2})
        EXPECT_THAT(complaint(account, without(rocks, p)), HasSubstr("rock " + std::to_string(rocks.id[p]))) << p;
    Rocks changed = rocks;
    changed.diameter[1] *= 1.0 - 1e-12;
    EXPECT_THAT(complaint(account, changed), HasSubstr("rock 5 has"));
    Rocks swapped = rocks;
    swapped.id[1] = 6;
    EXPECT_THAT(complaint(account, swapped), HasSubstr("rock 5 of"));
    account.take_out(3, Whereabouts::removed);
    EXPECT_THAT(complaint(account, rocks), HasSubstr("rock 3 is in the run"));
    EXPECT_THROW(account.take_out(3, Whereabouts::removed), CheckFailure);
    EXPECT_THROW(account.take_out(4, Whereabouts::removed), CheckFailure);
    EXPECT_THROW(account.place(rocks, std::array<std::size_t, 1>{0}), CheckFailure);
    Rocks more = rocks;
    more.append({9, Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), 0.01, 2650.0});
    EXPECT_THAT(complaint(account_of(rocks), more), HasSubstr("rock 9 is in the run"));
}

}  // namespace
}  // namespace cutterflow::coupling
