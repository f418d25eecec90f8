// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Own code, because Debian has no PLY library that keeps doubles, normals and further properties of
// a cloud without faces; PCL's reader draws in VTK.
#include "io/point_table.h"
#include "io/scalar_type.h"
#include "io/text_cursor.h"

#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

namespace opp::mapping {
namespace {

using Kind = ScalarType::Kind;

struct Property {
  std::string name;
  ScalarType type;
  std::optional<ScalarType> count_type;  ///< of a list
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

enum class Encoding { kText, kLittleEndian, kBigEndian };

struct Header {
  Encoding encoding = Encoding::kText;
  std::vector<Element> elements;
};

std::optional<ScalarType> scalarType(std::string_view name) {
  static constexpr std::array<std::pair<std::string_view, ScalarType>, 16> kTypes = {{
      {"char", {Kind::kSigned, 1}},
      {"int8", {Kind::kSigned, 1}},
      {"uchar", {Kind::kUnsigned, 1}},
      {"uint8", {Kind::kUnsigned, 1}},
      {"short", {Kind::kSigned, 2}},
      {"int16", {Kind::kSigned, 2}},
      {"ushort", {Kind::kUnsigned, 2}},
      {"uint16", {Kind::kUnsigned, 2}},
      {"int", {Kind::kSigned, 4}},
      {"int32", {Kind::kSigned, 4}},
      {"uint", {Kind::kUnsigned, 4}},
      {"uint32", {Kind::kUnsigned, 4}},
      {"float", {Kind::kFloat, 4}},
      {"float32", {Kind::kFloat, 4}},
      {"double", {Kind::kFloat, 8}},
      {"float64", {Kind::kFloat, 8}},
  }};
  for (const auto& [known, type] : kTypes) {
    if (known == name) return type;
  }
  return std::nullopt;
}

Encoding parseFormat(const TextCursor& cursor, const std::vector<std::string_view>& words) {
  if (words.size() == 3 && words[2] == "1.0") {
    if (words[1] == "ascii") return Encoding::kText;
    if (words[1] == "binary_little_endian") return Encoding::kLittleEndian;
    if (words[1] == "binary_big_endian") return Encoding::kBigEndian;
  }
  cursor.fail(
      "unknown PLY format; known are ascii, binary_little_endian and binary_big_endian 1.0");
}

Property parseProperty(const TextCursor& cursor, const std::vector<std::string_view>& words) {
  const bool list = words.size() == 5 && words[1] == "list";
  if (!list && words.size() != 3) cursor.fail("a property needs a type and a name");
  const auto type = scalarType(words[list ? 3 : 1]);
  const auto count_type = list ? scalarType(words[2]) : std::nullopt;
  if (!type || (list && !count_type)) cursor.fail("unknown property type");
  return {std::string(words.back()), *type, count_type};
}

Header parseHeader(TextCursor& cursor) {
  if (cursor.nextLine() != "ply") cursor.fail("not a PLY file: it does not start with 'ply'");
  Header header;
  bool has_format = false;
  while (!cursor.atEnd()) {
    const auto words = splitWords(cursor.nextLine());
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") {
      if (!has_format) cursor.fail("the header names no format");
      return header;
    }
    if (words[0] == "format") {
      header.encoding = parseFormat(cursor, words);
      has_format = true;
    } else if (words[0] == "element") {
      Element element;
      if (words.size() != 3 || !parseCount(words[2], element.count)) {
        cursor.fail("an element needs a name and a count");
      }
      element.name = words[1];
      header.elements.push_back(element);
    } else if (words[0] == "property" && !header.elements.empty()) {
      header.elements.back().properties.push_back(parseProperty(cursor, words));
    } else {
      cursor.fail("'" + std::string(words[0].substr(0, 32)) + "' is not known in a PLY header");
    }
  }
  cursor.fail("the header has no end; the file is truncated or not a PLY file");
}

/// Numbers of a text body.
class TextValues {
 public:
  explicit TextValues(TextCursor cursor) : cursor_(cursor) {}
  double next(ScalarType) { return cursor_.nextNumber(); }
  [[noreturn]] void fail(const std::string& what) const { cursor_.fail(what); }

 private:
  TextCursor cursor_;
};

/// Numbers of a binary body.
class BinaryValues {
 public:
  BinaryValues(std::string_view file, std::size_t start, bool big_endian)
      : file_(file), position_(start), big_endian_(big_endian) {}
  double next(ScalarType type) {
    if (file_.size() - position_ < type.bytes) {
      fail("the file ends before all of its points; it is truncated");
    }
    const double value = decodeScalar(file_.data() + position_, type, big_endian_);
    position_ += type.bytes;
    return value;
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error("byte " + std::to_string(position_) + ": " + what);
  }

 private:
  std::string_view file_;
  std::size_t position_;
  bool big_endian_;
};

/// Reads a property and returns it; a list is passed over.
template <typename Values>
double readProperty(Values& values, const Property& property) {
  if (!property.count_type) return values.next(property.type);
  const double count = values.next(*property.count_type);
  if (!(count >= 0.0) || count != std::floor(count)) values.fail("the length of a list is invalid");
  for (double k = 0.0; k < count; k += 1.0) values.next(property.type);
  return 0.0;
}

/// Columns of the properties, in their order; null for those that are passed over.
std::vector<std::vector<double>*> makeColumns(const Element& element, PointTable& table) {
  std::vector<std::vector<double>*> columns;
  for (const Property& property : element.properties) {
    const std::string name = property.count_type ? std::string() : columnName(property.name);
    columns.push_back(name.empty() || table.columns.count(name) > 0 ? nullptr
                                                                    : &table.columns[name]);
  }
  return columns;
}

template <typename Values>
PointTable readBody(Values values, const Header& header) {
  PointTable table;
  for (const Element& element : header.elements) {
    // Nothing stands in the file for an element without properties, however often it is there.
    if (element.properties.empty()) continue;
    const bool points = element.name == "vertex";
    const auto columns = points ? makeColumns(element, table)
                                : std::vector<std::vector<double>*>(element.properties.size());
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (std::size_t k = 0; k < columns.size(); ++k) {
        const double value = readProperty(values, element.properties[k]);
        if (columns[k] != nullptr) columns[k]->push_back(value);
      }
    }
    if (!points) continue;
    table.size = static_cast<std::size_t>(element.count);
    return table;
  }
  throw std::runtime_error("the file has no element 'vertex'");
}

}  // namespace

PointTable readPly(std::string_view file) {
  TextCursor cursor(file);
  const Header header = parseHeader(cursor);
  if (header.encoding == Encoding::kText) return readBody(TextValues(cursor), header);
  return readBody(BinaryValues(file, cursor.position(), header.encoding == Encoding::kBigEndian),
                  header);
}

}  // namespace opp::mapping
