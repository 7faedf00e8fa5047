#include "server/http/byte_range.h"

#include <algorithm>
#include <charconv>

#include "server/http/text.h"

namespace sheer::http {

namespace {

class SlicedContent : public Content {
  public:
    SlicedContent(ContentPtr whole, ByteRange range) : m_whole(std::move(whole)), m_range(range) {}
    std::uint64_t size_bytes() const override { return m_range.end - m_range.begin; }
    void read(std::uint64_t offset, std::span<char> bytes) const override {
        m_whole->read(m_range.begin + offset, bytes);
    }

  private:
    ContentPtr m_whole;
    ByteRange m_range;
};

std::optional<std::uint64_t> whole_number(std::string_view text) {
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

}  // namespace

std::optional<ByteRange> byte_range(std::string_view field, std::uint64_t size) {
    constexpr std::string_view unit = "bytes=";
    if (!field.starts_with(unit)) return std::nullopt;
    const std::string_view range = trimmed(field.substr(unit.size()));
    const std::size_t dash = range.find('-');
    if (dash == std::string_view::npos) return std::nullopt;
    const std::string_view first = range.substr(0, dash), last = range.substr(dash + 1);
    const auto begin = whole_number(first), end = whole_number(last);
    if ((!first.empty() && !begin) || (!last.empty() && !end) || (first.empty() && last.empty())) return std::nullopt;
    if (first.empty()) return ByteRange{size - std::min(*end, size), size};
    if (end && *end < *begin) return std::nullopt;
    if (*begin >= size) return ByteRange{};
    return ByteRange{*begin, end ? std::min(*end, size - 1) + 1 : size};
}

ContentPtr slice_of(ContentPtr whole, ByteRange range) {
    return std::make_shared<SlicedContent>(std::move(whole), range);
}

}  // namespace sheer::http
