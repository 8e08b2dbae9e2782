// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/policy/policy.hpp"

namespace hotfire::explain {

namespace {

Policy& in_force() {
  static Policy policy;
  return policy;
}

}  // namespace

const Policy& policy() { return in_force(); }

WithPolicy::WithPolicy(const Policy& other) : before_(in_force()) { in_force() = other; }

WithPolicy::~WithPolicy() { in_force() = before_; }

}  // namespace hotfire::explain
