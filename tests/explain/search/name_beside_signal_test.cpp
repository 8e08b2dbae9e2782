// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/search/name_beside_signal.hpp"

#include <CppUTest/TestHarness.h>

#include <string>
#include <vector>

#include "tests/explain/latent/missing_effect.hpp"
#include "tests/support/add_effect.hpp"

namespace {

using namespace hotfire;

/// Every law beside the declared model, screened: the best first.
std::vector<explain::Screened> screened_in(const explain::Dataset& data) {
  const explain::Fitted about = test::about_declared();
  const explain::Evaluator evaluator(data, explain::Resolution::coarse);
  const explain::Screening screening(evaluator, about, explain::scales_of(about.base, data), 2);
  return screening.run(explain::candidates_beside(about.base, data), "test", {});
}

std::string name_in(const explain::Dataset& data, const std::vector<explain::Screened>& screened) {
  const auto name = explain::name_that_saves_most(data, test::about_declared(), screened, 0.9, 2, {});
  return name ? name->candidate.name : "none";
}

/// A flow with the product of two quantities: a law that is in no list.
void add_product(ModelFile& truth, double gain) {
  test::add_effect<model::Term<model::Site::flow>>(std::get<SimplexParameters>(truth.parameters), [&](auto& term) {
    term.argument = static_cast<int>(model::Argument::rate);
    term.factor = 1 + static_cast<int>(model::Argument::position);
    term.gain = gain;
  });
}

}  // namespace

TEST_GROUP(NameBesideSignal){};

// Alone, a variable moment arm ranks first.
TEST(NameBesideSignal, TheMissingNameIsFoundWhereAnotherExplainsAsMuchAlone) {
  ModelFile truth = test::with_effect<model::SensorNonlinearity>({5.0, 100.0}, 0);
  add_product(truth, 2.0);
  const auto data = test::data_of(truth);
  const auto screened = screened_in(data);
  CHECK(screened.front().candidate.name != model::SensorNonlinearity::name);
  STRCMP_EQUAL("sensor_nonlinearity", name_in(data, screened).c_str());
}

TEST(NameBesideSignal, NoNameIsFoundWhereASignalRepresentsAllThatIsMissing) {
  ModelFile truth = test::declared();
  add_product(truth, 0.3);
  const auto data = test::data_of(truth);
  STRCMP_EQUAL("none", name_in(data, screened_in(data)).c_str());
}
