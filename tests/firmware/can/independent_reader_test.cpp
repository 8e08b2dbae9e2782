// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "firmware/can/can_map.hpp"
#include "firmware/can/codec.hpp"

namespace hotfire::firmware::can {
namespace {

hal::CanFrame frame_of(const std::string& text) {
  hal::CanFrame frame;
  const std::size_t mark = text.find('#');
  frame.id.value = static_cast<std::uint32_t>(std::stoul(text.substr(0, mark), nullptr, 16));
  frame.fd = text[mark + 1] == '#';
  for (std::size_t i = mark + (frame.fd ? 3 : 1); i < text.size(); i += 2) {
    frame.data[frame.length++] = static_cast<std::uint8_t>(std::stoul(text.substr(i, 2), nullptr, 16));
  }
  return frame;
}

const Message* named(const std::string& name) {
  for (const Message* message : kMessages) {
    if (message->name == name) {
      return message;
    }
  }
  return nullptr;
}

}  // namespace

TEST_GROUP(IndependentReader){};

TEST(IndependentReader, UnderstandsEveryFrameOfTheFirmwareAsTheFirmwareDoes) {
  std::ifstream file(HOTFIRE_CAN_TESTS "/independent_reader.txt");
  std::set<std::string> seen;
  std::string line;
  while (std::getline(file, line)) {
    if (line.starts_with('#')) {
      continue;
    }
    std::istringstream words(line);
    std::string frame;
    std::string name;
    words >> frame >> name;
    const Message* message = named(name);
    CHECK(message != nullptr);
    std::array<double, 32> values{};
    std::uint8_t counter = 0;
    CHECK(decode(*message, frame_of(frame), values, counter) == Decoding::good);
    std::string word;
    words >> word;  // the check, which decoding has looked at
    words >> word;
    STRCMP_EQUAL(word.c_str(), ("counter=" + std::to_string(counter)).c_str());
    for (std::size_t i = 0; i < message->signals.size(); ++i) {
      const Signal& signal = message->signals[i];
      CHECK(static_cast<bool>(words >> word));
      const std::size_t equals = word.find('=');
      STRCMP_EQUAL(std::string(signal.name).c_str(), word.substr(0, equals).c_str());
      // Rounding of a double; one code more or less would be the whole factor.
      DOUBLES_EQUAL(std::stod(word.substr(equals + 1)), values[i], 1e-6 * signal.factor);
    }
    // Freshness and code, which the codec leaves to who has the key: the last bytes of the frame.
    const hal::CanFrame bytes = frame_of(frame);
    for (std::size_t i = 0; message->can_be_authenticated && i < 3; ++i) {
      CHECK(static_cast<bool>(words >> word));
      std::uint32_t number = 0;
      std::memcpy(&number, bytes.data.data() + bytes.length - 12 + 4 * i, sizeof number);
      UNSIGNED_LONGS_EQUAL(number, std::stoul(word.substr(word.find('=') + 1)));
    }
    CHECK(words.eof());
    seen.insert(name);
  }
  UNSIGNED_LONGS_EQUAL(kMessages.size(), seen.size());
}

}  // namespace hotfire::firmware::can
