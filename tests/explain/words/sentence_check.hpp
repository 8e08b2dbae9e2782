// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <vector>

/// What is wrong with texts that a program prints, and the texts themselves.
class SentenceCheck {
 public:
  /// Reads the replaced words from the list of tools/style/english.cmake below `source`.
  explicit SentenceCheck(const std::string& source);

  /// A fault in words for a text of one sentence or more; empty if there is none.
  std::string fault_of(const std::string& text) const;
  /// Keeps a text and what is wrong with it.
  void add(const std::string& text);

  const std::set<std::string>& texts() const { return texts_; }
  /// "FAULT: TEXT", a line each.
  const std::string& faults() const { return faults_; }
  std::size_t replaced_words() const { return replaced_.size(); }

 private:
  std::vector<std::string> replaced_;
  std::set<std::string> texts_;
  std::string faults_;
};

/// The sentences of a text: each ends with a full stop before a blank, or with the text.
std::vector<std::string> sentences_of(const std::string& text);

/// Words of a text: what blanks separate, if it has a letter or a digit.
std::size_t words_in(const std::string& text);

/// "FILE:LINE: LITERAL" for each string literal of six words or more in the sources of tools/explain that the test does not
/// print: outside of the files whose sentences it builds, and no report of progress.
std::vector<std::string> sentences_elsewhere(const std::string& source);
