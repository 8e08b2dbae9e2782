// SPDX-License-Identifier: Apache-2.0
#include "tests/explain/words/sentence_check.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

namespace {

constexpr std::size_t kMostWords = 25;
/// A sentence of ours begins with its subject, or with a short condition, never with one of these.
constexpr std::array kInverted{"hardly ", "nor ", "neither ", "never ", "only ", "beside it "};

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

bool has_word(const std::string& text, const std::string& word) {
  const auto is_inside = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || !is_inside(static_cast<unsigned char>(text[at - 1]))) &&
        (end == text.size() || !is_inside(static_cast<unsigned char>(text[end])))) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::vector<std::string> sentences_of(const std::string& text) {
  std::vector<std::string> sentences;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t stop = text.find(". ", begin);
    const std::size_t end = stop == std::string::npos ? text.size() : stop + 1;
    sentences.push_back(text.substr(begin, end - begin));
    begin = end == text.size() ? end : end + 1;
  }
  return sentences;
}

std::size_t words_in(const std::string& text) {
  std::istringstream blanks(text);
  return static_cast<std::size_t>(std::count_if(std::istream_iterator<std::string>(blanks), {}, [](const std::string& word) {
    return std::ranges::any_of(word, [](unsigned char c) { return std::isalnum(c) != 0; });
  }));
}

SentenceCheck::SentenceCheck(const std::string& source) {
  const std::string list = content_of(std::filesystem::path(source) / "tools/style/english.cmake");
  const std::regex pair("\n  \"([^|\"]*)[|][^\"]*\"");
  for (auto found = std::sregex_iterator(list.begin(), list.end(), pair); found != std::sregex_iterator(); ++found) {
    replaced_.push_back((*found)[1]);
  }
}

std::string SentenceCheck::fault_of(const std::string& text) const {
  if (text.empty() || text.front() == ' ' || text.back() == ' ' || text.find("  ") != std::string::npos) {
    return "no text, or a blank too many";
  }
  if (text.find_first_of("{}") != std::string::npos) {
    return "a placeholder is not filled";
  }
  for (const char* mark : {" .", " ,", "..", ",,", ": .", "()", " ;", " a none"}) {
    if (text.find(mark) != std::string::npos) {
      return std::string("'") + mark + "'";
    }
  }
  for (const std::string& word : replaced_) {
    if (has_word(lower(text), word)) {
      return "'" + word + "' has a standard term";
    }
  }
  for (const std::string& sentence : sentences_of(text)) {
    if (words_in(sentence) > kMostWords) {
      return std::to_string(words_in(sentence)) + " words";
    }
    for (const char* inverted : kInverted) {
      if (lower(sentence).starts_with(inverted)) {
        return std::string("begins with '") + inverted + "'";
      }
    }
  }
  return "";
}

void SentenceCheck::add(const std::string& text) {
  texts_.insert(text);
  if (const std::string fault = fault_of(text); !fault.empty()) {
    faults_ += fault + ": " + text + "\n";
  }
}

std::vector<std::string> sentences_elsewhere(const std::string& source) {
  constexpr std::size_t kSentence = 6;
  // What the test calls with every input; names of the axes of a curve; the text of a profile's file.
  constexpr std::array kPrinted{"tools/explain/words/", "tools/explain/policy/policy.hpp",
                                "tools/explain/terms/unlisted_words.cpp", "tools/explain/result/curve.cpp",
                                "tools/explain/experiment/test_profiles.cpp"};
  const std::regex literal("\"(\\\\.|[^\"\\\\])*\"");
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(std::filesystem::path(source) / "tools/explain")) {
    const std::string name = std::filesystem::relative(entry.path(), source).string();
    const bool is_printed =
        std::ranges::any_of(kPrinted, [&](const char* printed) { return name.find(printed) != std::string::npos; });
    if (is_printed || (entry.path().extension() != ".cpp" && entry.path().extension() != ".hpp")) {
      continue;
    }
    std::ifstream file(entry.path());
    std::string line;
    for (std::size_t number = 1; std::getline(file, line); ++number) {
      const std::size_t comment = line.find("//");
      line = line.substr(0, comment);
      if (line.find("progress(") != std::string::npos || line.find("Work::") != std::string::npos ||
          line.find("#include") != std::string::npos) {
        continue;
      }
      for (auto text = std::sregex_iterator(line.begin(), line.end(), literal); text != std::sregex_iterator(); ++text) {
        if (words_in(text->str()) >= kSentence) {
          found.push_back(name + ":" + std::to_string(number) + ": " + text->str());
        }
      }
    }
  }
  return found;
}
