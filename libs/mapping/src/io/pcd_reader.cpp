// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Own code, because PCL's reader draws in VTK; the compression is liblzf's.
#include "io/point_table.h"
#include "io/scalar_type.h"
#include "io/text_cursor.h"

#include <liblzf/lzf.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>

namespace opp::mapping {
namespace {

using Words = std::vector<std::string_view>;

struct PcdField {
  std::string name;
  ScalarType type;
  std::uint64_t count = 1;  ///< numbers per point
  std::size_t bytes() const { return type.bytes * static_cast<std::size_t>(count); }
};

struct PcdHeader {
  std::vector<PcdField> fields;
  std::uint64_t width = 0;
  std::uint64_t height = 1;
  std::optional<std::uint64_t> points;
  Eigen::Vector3f viewpoint = Eigen::Vector3f::Zero();
  std::string_view encoding;  ///< ascii, binary or binary_compressed

  std::size_t pointBytes() const {
    std::size_t sum = 0;
    for (const PcdField& field : fields) sum += field.bytes();
    return sum;
  }
};

/// Bytes of a point or of a grid's side above this are not from a point cloud.
constexpr std::uint64_t kLargest = std::numeric_limits<std::int32_t>::max();

std::uint64_t countIn(const TextCursor& cursor, std::string_view word) {
  std::uint64_t count = 0;
  if (!parseCount(word, count) || count > kLargest) cursor.fail("a count is not valid");
  return count;
}

void parseSizes(const TextCursor& cursor, const Words& words, PcdHeader& header) {
  for (std::size_t k = 0; k < header.fields.size(); ++k) {
    const std::uint64_t bytes = countIn(cursor, words[k + 1]);
    if (bytes != 1 && bytes != 2 && bytes != 4 && bytes != 8) {
      cursor.fail("a SIZE must be 1, 2, 4 or 8");
    }
    header.fields[k].type.bytes = static_cast<std::size_t>(bytes);
  }
}

void parseTypes(const TextCursor& cursor, const Words& words, PcdHeader& header) {
  for (std::size_t k = 0; k < header.fields.size(); ++k) {
    const std::string_view word = words[k + 1];
    if (word != "F" && word != "I" && word != "U") cursor.fail("a TYPE must be F, I or U");
    header.fields[k].type.kind = word == "F"   ? ScalarType::Kind::kFloat
                                 : word == "I" ? ScalarType::Kind::kSigned
                                               : ScalarType::Kind::kUnsigned;
  }
}

void parseCounts(const TextCursor& cursor, const Words& words, PcdHeader& header) {
  for (std::size_t k = 0; k < header.fields.size(); ++k) {
    header.fields[k].count = countIn(cursor, words[k + 1]);
  }
}

void parseViewpoint(const TextCursor& cursor, const Words& words, PcdHeader& header) {
  for (int k = 0; k < 3; ++k) {
    double number = 0.0;
    if (words.size() != 8 || !parseNumber(words[static_cast<std::size_t>(k) + 1], number)) {
      cursor.fail("a VIEWPOINT needs seven numbers");
    }
    header.viewpoint[k] = static_cast<float>(number);
  }
}

/// One line of the header. The lines FIELDS, SIZE, TYPE, COUNT come in this order.
void parseLine(const TextCursor& cursor, const Words& words, PcdHeader& header) {
  const std::string_view key = words[0];
  const bool per_field = key == "SIZE" || key == "TYPE" || key == "COUNT";
  if (per_field && words.size() != header.fields.size() + 1) {
    cursor.fail(std::string(key) + " needs one entry per field");
  }
  if ((key == "WIDTH" || key == "HEIGHT" || key == "POINTS") && words.size() != 2) {
    cursor.fail(std::string(key) + " needs one number");
  }
  if (key == "FIELDS" || key == "COLUMNS") {
    for (std::size_t k = 1; k < words.size(); ++k)
      header.fields.push_back({std::string(words[k]), {}, 1});
  } else if (key == "SIZE") {
    parseSizes(cursor, words, header);
  } else if (key == "TYPE") {
    parseTypes(cursor, words, header);
  } else if (key == "COUNT") {
    parseCounts(cursor, words, header);
  } else if (key == "WIDTH") {
    header.width = countIn(cursor, words[1]);
  } else if (key == "HEIGHT") {
    header.height = countIn(cursor, words[1]);
  } else if (key == "POINTS") {
    header.points = countIn(cursor, words[1]);
  } else if (key == "VIEWPOINT") {
    parseViewpoint(cursor, words, header);
  } else if (key != "VERSION") {
    cursor.fail("'" + std::string(key.substr(0, 32)) + "' is not known in a PCD header");
  }
}

void checkHeader(const TextCursor& cursor, const PcdHeader& header) {
  if (header.fields.empty()) cursor.fail("the header names no FIELDS");
  for (const PcdField& field : header.fields) {
    if (field.type.kind == ScalarType::Kind::kFloat && field.type.bytes < 4) {
      cursor.fail("a field of type F must have SIZE 4 or 8");
    }
  }
  if (header.pointBytes() == 0) cursor.fail("the fields have no size");
  if (header.points && *header.points != header.width * header.height) {
    cursor.fail("POINTS is not WIDTH x HEIGHT");
  }
}

PcdHeader parseHeader(TextCursor& cursor) {
  PcdHeader header;
  while (!cursor.atEnd()) {
    const Words words = splitWords(cursor.nextLine());
    if (words.empty() || words[0].front() == '#') continue;
    if (words[0] != "DATA") {
      parseLine(cursor, words, header);
      continue;
    }
    checkHeader(cursor, header);
    header.encoding = words.size() == 2 ? words[1] : std::string_view();
    if (header.encoding != "ascii" && header.encoding != "binary" &&
        header.encoding != "binary_compressed") {
      cursor.fail("unknown DATA; known are ascii, binary and binary_compressed");
    }
    return header;
  }
  cursor.fail("no DATA; the file is truncated or not a PCD file");
}

void readText(TextCursor& cursor, const PcdHeader& header, PointTable& table) {
  for (std::size_t i = 0; i < table.size; ++i) {
    for (const PcdField& field : header.fields) {
      const auto column = table.columns.find(columnName(field.name));
      for (std::uint64_t k = 0; k < field.count; ++k) {
        const double value = cursor.nextNumber();
        if (k == 0 && column != table.columns.end()) column->second.push_back(value);
      }
    }
  }
}

/// \param packed the fields stand one after the other as whole columns (compressed files).
void readBinary(std::string_view data, const PcdHeader& header, bool packed, PointTable& table) {
  std::size_t start = 0;
  for (const PcdField& field : header.fields) {
    const auto column = table.columns.find(columnName(field.name));
    const std::size_t step = packed ? field.bytes() : header.pointBytes();
    for (std::size_t i = 0; column != table.columns.end() && i < table.size; ++i) {
      column->second.push_back(decodeScalar(data.data() + start + i * step, field.type, false));
    }
    start += packed ? field.bytes() * table.size : field.bytes();
  }
}

std::string decompress(std::string_view body, std::size_t expected) {
  constexpr ScalarType kCount{ScalarType::Kind::kUnsigned, 4};
  constexpr std::size_t kPrefix = 8;  // compressed and plain size
  if (body.size() < kPrefix) throw std::runtime_error("the file is truncated before its points");
  const auto compressed = static_cast<std::size_t>(decodeScalar(body.data(), kCount, false));
  const auto plain = static_cast<std::size_t>(decodeScalar(body.data() + 4, kCount, false));
  if (plain != expected) throw std::runtime_error("the compressed size does not fit the header");
  if (compressed > body.size() - kPrefix) {
    throw std::runtime_error("the compressed points are truncated");
  }
  std::string out(plain, '\0');
  if (plain > 0 && lzf_decompress(body.data() + kPrefix, static_cast<unsigned int>(compressed),
                                  out.data(), static_cast<unsigned int>(plain)) != plain) {
    throw std::runtime_error("the compressed points are damaged");
  }
  return out;
}

PointTable makeTable(const PcdHeader& header) {
  PointTable table;
  table.viewpoint = header.viewpoint;
  table.size = static_cast<std::size_t>(header.width * header.height);
  if (header.height > 1 && header.width > 0) {
    table.rows = static_cast<int>(header.height);
    table.cols = static_cast<int>(header.width);
  }
  for (const PcdField& field : header.fields) {
    const std::string name = columnName(field.name);
    if (!name.empty() && field.count > 0) table.columns[name];
  }
  return table;
}

}  // namespace

PointTable readPcd(std::string_view file) {
  TextCursor cursor(file);
  const PcdHeader header = parseHeader(cursor);
  PointTable table = makeTable(header);
  if (header.encoding == "ascii") {
    readText(cursor, header, table);
    return table;
  }
  const std::string_view body = file.substr(cursor.position());
  if (table.size > kLargest * 64 / header.pointBytes()) cursor.fail("WIDTH x HEIGHT is too large");
  const std::size_t bytes = table.size * header.pointBytes();
  if (header.encoding == "binary_compressed") {
    readBinary(decompress(body, bytes), header, true, table);
    return table;
  }
  if (body.size() < bytes) {
    throw std::runtime_error("byte " + std::to_string(file.size()) +
                             ": the file ends before all of its " + std::to_string(table.size) +
                             " points; it is truncated");
  }
  readBinary(body, header, false, table);
  return table;
}

}  // namespace opp::mapping
