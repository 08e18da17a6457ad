// Kernel arguments have quantity types: calls with swapped or missing fields do not compile.
#include "sim/fields.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <type_traits>

#include "reference/test_scene.h"

namespace mcdem {
namespace {

using FillCells = decltype(Kernels::fill_cells);
template <class... Arguments>
constexpr bool callable = std::is_invocable_v<FillCells&, std::size_t, std::size_t, const Arguments&...>;

static_assert(callable<Field<Constants>, Field<Blocks>, Now<Motion>, Field<CellHead>, Field<CellNext>>);
static_assert(!callable<Field<Constants>, Field<Blocks>, Next<Motion>, Field<CellHead>, Field<CellNext>>,
              "what a step writes is not what it reads");
static_assert(!callable<Field<Constants>, Field<Blocks>, Now<Motion>, Field<CellNext>, Field<CellHead>>,
              "swapped");
static_assert(!callable<Field<Constants>, Field<Blocks>, Now<Motion>, Field<CellHead>>, "one is missing");
static_assert(!callable<Field<Constants>, Field<Blocks>, int, Field<CellHead>, Field<CellNext>>,
              "a number is no field");

template <class A, class B>
constexpr bool assignable = std::is_assignable_v<Field<A>&, const Field<B>&>;
static_assert(assignable<CellHead, CellHead> && !assignable<CellHead, CellNext>,
              "fields of one form and another quantity do not mix");

TEST(TypedArguments, AreCheckedWhenThisFileIsCompiled) {}

TEST(TypedArguments, AreCountedWhenAKernelIsMade) {
    const KernelBuild build = reference::build(Precision::single_precision);
    const cl::Program program = build_program(reference::device(), build);
    using TooFew = Kernel<Field<Constants>, Field<Portions>>;
    EXPECT_THAT([&] { TooFew(reference::device(), program, "empty_cells", build.list_items()); },
                testing::ThrowsMessage<RunError>(testing::HasSubstr("takes 3 arguments, the host has 2")));
}

}  // namespace
}  // namespace mcdem
