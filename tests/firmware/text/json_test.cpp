// SPDX-License-Identifier: Apache-2.0
#include "firmware/text/json.hpp"

#include <CppUTest/TestHarness.h>

#include <limits>

using hotfire::firmware::Json;

TEST_GROUP(Json) { Json json; };

TEST(Json, ObjectsAndListsNestWithTheirCommas) {
  json.open();
  json.open("empty");
  json.close();
  json.open_list("list");
  json.open();
  json.add("a", 1);
  json.add("b", true);
  json.close();
  json.open();
  json.close();
  json.close_list();
  json.add("x", 0.5);
  json.close();
  STRCMP_EQUAL("{\"empty\":{},\"list\":[{\"a\":1,\"b\":true},{}],\"x\":0.5}", json.text().c_str());
}

TEST(Json, TextIsEscaped) {
  json.open();
  json.add("t", "say \"a\\b\"\n");
  json.close();
  STRCMP_EQUAL("{\"t\":\"say \\\"a\\\\b\\\"\\u000a\"}", json.text().c_str());
}

TEST(Json, NumberThatIsNotFiniteIsNull) {
  json.open();
  json.add("n", std::numeric_limits<double>::quiet_NaN());
  json.close();
  STRCMP_EQUAL("{\"n\":null}", json.text().c_str());
}
