// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/report/located_json.hpp"

namespace hotfire::explain {

using nlohmann::json;

json located_json(const Dataset& data, const Located& located) {
  json places = json::array();
  for (const Place& place : located.places) {
    json row{{"sites", place.sites}, {"log_likelihood_gain", place.gain}, {"likely", place.is_likely}};
    for (std::size_t c = 0; c < place.leaves.size(); ++c) {
      if (data.used[c]) {
        row["mean_square_over_noise"][data.channels[c]] = place.leaves[c];
      }
    }
    places.push_back(std::move(row));
  }
  return {{"sites", located.likely_sites()}, {"single", located.is_single}, {"places", places}};
}

}  // namespace hotfire::explain
