#include "tools/explain/terms/unlisted.hpp"

#include <fmt/format.h>

#include "tools/explain/terms/table_points.hpp"

namespace hotfire::explain {

namespace {

template <class E>
constexpr bool is_unlisted_effect() {
  return requires { E::is_unlisted; };
}

}  // namespace

template <class Family>
bool is_unlisted(const Candidate& candidate) {
  bool result = false;
  const PlainParameters<Family> neutral;
  model::visit_effects(neutral, [&]<class E>(std::size_t index, const auto&) {
    result = result || (index == candidate.effect && is_unlisted_effect<E>());
  });
  return result;
}

template <class Family>
std::vector<Candidate> unlisted_candidates(const Dataset& data) {
  std::vector<Candidate> candidates;
  const PlainParameters<Family> neutral;
  model::visit_effects(neutral, [&]<class E>(std::size_t index, const auto&) {
    if constexpr (is_unlisted_effect<E>() && !requires { E::is_term; }) {
      for (std::size_t option = 0; option < E::options.size(); ++option) {
        if (model::needs_other_axis<E>(static_cast<int>(option)) && !data.has_other_axis()) {
          continue;
        }
        Candidate candidate{index, static_cast<int>(option), std::string(E::name), std::string(E::options[option]),
                            std::string(model::site_name(E::site))};
        if constexpr (E::site == model::Site::sensor) {
          if (!data.used[option]) {
            continue;
          }
          candidate.site = fmt::format("{}.{}", candidate.site, candidate.option_name);
        }
        candidates.push_back(std::move(candidate));
      }
    }
  });
  return candidates;
}

template <class Family>
void activate_unlisted(PlainParameters<Family>& parameters, const Candidate& candidate, const Dataset& data,
                       const Fitted<Family>& current) {
  activate<Family>(parameters, candidate);
  lay_table(parameters, candidate, data, current);
}

template <class Family>
std::optional<FittedTable> table_of(const PlainParameters<Family>& parameters, const Candidate& candidate) {
  std::optional<FittedTable> result;
  visit_table(parameters, candidate, [&]<class>(const auto& field, const auto& table) {
    if (table.points > 0) {
      result = FittedTable{std::string(field.x_name),
                           std::string(field.x_unit),
                           std::string(field.y_name),
                           std::string(field.y_unit),
                           std::string(field.meaning),
                           {table.x.begin(), table.x.begin() + table.points},
                           {table.y.begin(), table.y.begin() + table.points}};
    }
  });
  return result;
}

#define HOTFIRE_INSTANTIATE(Family)                                                                       \
  template bool is_unlisted<Family>(const Candidate&);                                                    \
  template std::optional<FittedTable> table_of<Family>(const PlainParameters<Family>&, const Candidate&); \
  template std::vector<Candidate> unlisted_candidates<Family>(const Dataset&);                            \
  template void activate_unlisted<Family>(PlainParameters<Family>&, const Candidate&, const Dataset&, const Fitted<Family>&);

HOTFIRE_INSTANTIATE(SimplexFamily)
HOTFIRE_INSTANTIATE(DirectFamily)
#undef HOTFIRE_INSTANTIATE

}  // namespace hotfire::explain
