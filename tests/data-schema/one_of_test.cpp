// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/base/one_of.hpp"

#include <gtest/gtest.h>

#include <string>
#include <type_traits>
#include <variant>

#include "data-schema/scene/scene.hpp"

namespace tacto::schema {
namespace {

struct Wall {
  double stiffness = 0;
};
struct Fluid {
  double viscosity = 0;
};
using Thing = OneOf<Wall, Fluid>;

struct OfWalls {
  std::string operator()(const Wall& /*wall*/) const { return "wall"; }
};
struct OfFluids {
  std::string operator()(const Fluid& /*fluid*/) const { return "fluid"; }
};

template <class Value, class... Handlers>
concept CanVisit = requires(Value value, Handlers... handlers) { value.visit(handlers...); };

template <class Value, class Kind>
concept CanGet = requires(Value value) { std::get<Kind>(value); } ||
                 requires(Value value) { std::get_if<Kind>(&value); } || std::is_convertible_v<Value, Kind>;

TEST(OneOf, code_that_leaves_out_a_kind_does_not_compile) {
  static_assert(CanVisit<const Thing, OfWalls, OfFluids> && CanVisit<Thing, OfWalls, OfFluids>);
  static_assert(!CanVisit<const Thing, OfWalls> && !CanVisit<Thing, OfFluids>);
  static_assert(!CanGet<Thing, Wall> && CanGet<std::variant<Wall, Fluid>, Wall>);
  const Thing wall = Wall{3}, fluid = Fluid{2};
  EXPECT_EQ(wall.visit(OfWalls{}, OfFluids{}), "wall");
  EXPECT_EQ(fluid.visit(OfWalls{}, OfFluids{}), "fluid");
}

TEST(OneOf, handlers_may_change_the_value) {
  Thing thing = Wall{3};
  thing.visit([](Wall& wall) { wall.stiffness *= 2; }, [](Fluid& fluid) { fluid.viscosity *= 2; });
  const auto figure = [](const Thing& of) {
    return of.visit([](const Wall& wall) { return wall.stiffness; },
                    [](const Fluid& fluid) { return -fluid.viscosity; });
  };
  EXPECT_EQ(figure(thing), 6);
}

// The type of a scene's layers guarantees it.
TEST(OneOf, a_layer_can_be_read_only_by_handling_every_kind) {
  static_assert(!CanGet<Layer, TextureLayer>);
  static_assert(!std::is_same_v<Layer, std::variant<TextureLayer>>);
  static_assert(!CanVisit<const Layer, OfWalls>);
  TextureLayer oak;
  oak.texture = "oak";
  const Layer layer = oak;
  EXPECT_EQ(layer.visit([](const TextureLayer& texture) { return texture.texture; }), "oak");
}

}  // namespace
}  // namespace tacto::schema
