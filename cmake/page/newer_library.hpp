// What the C++20 of this project needs and LLVM's library of Emscripten 3.1.6 (version 13) lacks:
// the algorithms over ranges, with projections, and the order of a few members by <=>.
// Force-included where the page's program is compiled; a library that has them makes it empty.
#pragma once

#include <version>

#if defined(_LIBCPP_VERSION) && !defined(__cpp_lib_ranges) && _LIBCPP_VERSION < 15000
#include <algorithm>
#include <array>
#include <compare>
#include <functional>
#include <iterator>
#include <optional>
#include <utility>

namespace std {
namespace ranges {

template <typename Range, typename Test, typename Projection>
auto page_find(Range&& range, Test test, Projection projection) {
  return std::find_if(std::begin(range), std::end(range), [&](auto&& element) {
    return std::invoke(test, std::invoke(projection, element));
  });
}

template <typename Range, typename Value, typename Projection = identity>
auto find(Range&& range, const Value& value, Projection projection = {}) {
  return page_find(
      range, [&](const auto& element) { return element == value; }, projection);
}

template <typename Iterator, typename Value>
requires requires(Iterator i) {
  *i;
  ++i;
}
Iterator find(Iterator begin, Iterator end, const Value& value) {
  return std::find(begin, end, value);
}

template <typename Range, typename Test, typename Projection = identity>
auto find_if(Range&& range, Test test, Projection projection = {}) {
  return page_find(range, test, projection);
}

template <typename Range, typename Test, typename Projection = identity>
bool any_of(Range&& range, Test test, Projection projection = {}) {
  return page_find(range, test, projection) != std::end(range);
}

template <typename Range, typename Test, typename Projection = identity>
bool none_of(Range&& range, Test test, Projection projection = {}) {
  return page_find(range, test, projection) == std::end(range);
}

template <typename Range, typename Test, typename Projection = identity>
bool all_of(Range&& range, Test test, Projection projection = {}) {
  return page_find(range, std::not_fn(test), projection) == std::end(range);
}

template <typename Range, typename Test, typename Projection = identity>
auto count_if(Range&& range, Test test, Projection projection = {}) {
  return std::count_if(std::begin(range), std::end(range), [&](auto&& element) {
    return std::invoke(test, std::invoke(projection, element));
  });
}

template <typename Range, typename Value, typename Projection = identity>
auto count(Range&& range, const Value& value, Projection projection = {}) {
  return ranges::count_if(
      range, [&](const auto& element) { return element == value; }, projection);
}

/// `order` of what `projection` makes of both.
template <typename Order, typename Projection>
auto page_projected(Order& order, Projection& projection) {
  return [&](auto&& a, auto&& b) -> bool {
    return std::invoke(order, std::invoke(projection, a), std::invoke(projection, b));
  };
}

template <typename Range, typename Order = less, typename Projection = identity>
void sort(Range&& range, Order order = {}, Projection projection = {}) {
  std::sort(std::begin(range), std::end(range), page_projected(order, projection));
}

template <typename Range, typename Order = less, typename Projection = identity>
void stable_sort(Range&& range, Order order = {}, Projection projection = {}) {
  std::stable_sort(std::begin(range), std::end(range), page_projected(order, projection));
}

template <typename Range, typename Order = less, typename Projection = identity>
auto min_element(Range&& range, Order order = {}, Projection projection = {}) {
  return std::min_element(std::begin(range), std::end(range), page_projected(order, projection));
}

template <typename Range, typename Order = less, typename Projection = identity>
auto max_element(Range&& range, Order order = {}, Projection projection = {}) {
  return std::max_element(std::begin(range), std::end(range), page_projected(order, projection));
}

template <typename Iterator>
struct page_least_and_most {
  Iterator min;
  Iterator max;
};

template <typename Range, typename Order = less, typename Projection = identity>
auto minmax_element(Range&& range, Order order = {}, Projection projection = {}) {
  const auto found =
      std::minmax_element(std::begin(range), std::end(range), page_projected(order, projection));
  return page_least_and_most<decltype(found.first)>{found.first, found.second};
}

template <typename Range, typename Order = less, typename Projection = identity>
auto minmax(Range&& range, Order order = {}, Projection projection = {}) {
  const auto found = ranges::minmax_element(range, order, projection);
  return page_least_and_most<std::decay_t<decltype(*found.min)>>{*found.min, *found.max};
}

template <typename Range>
auto min(Range&& range) {
  return *ranges::min_element(range);
}

template <typename Range>
auto max(Range&& range) {
  return *ranges::max_element(range);
}

template <typename Range, typename Value, typename Order = less, typename Projection = identity>
auto lower_bound(Range&& range, const Value& value, Order order = {}, Projection projection = {}) {
  return std::lower_bound(std::begin(range), std::end(range), value,
                          [&](const auto& element, const auto& bound) -> bool {
                            return std::invoke(order, std::invoke(projection, element), bound);
                          });
}

template <typename Range, typename Value, typename Order = less, typename Projection = identity>
auto upper_bound(Range&& range, const Value& value, Order order = {}, Projection projection = {}) {
  return std::upper_bound(std::begin(range), std::end(range), value,
                          [&](const auto& bound, const auto& element) -> bool {
                            return std::invoke(order, bound, std::invoke(projection, element));
                          });
}

template <typename Range, typename Test = equal_to, typename Projection = identity>
auto adjacent_find(Range&& range, Test test = {}, Projection projection = {}) {
  return std::adjacent_find(std::begin(range), std::end(range), page_projected(test, projection));
}

template <typename Range, typename Value>
void replace(Range&& range, const Value& before, const Value& after) {
  std::replace(std::begin(range), std::end(range), before, after);
}

template <typename Range, typename Test, typename Value>
void replace_if(Range&& range, Test test, const Value& after) {
  std::replace_if(std::begin(range), std::end(range), test, after);
}

template <typename Range, typename Value>
void fill(Range&& range, const Value& value) {
  std::fill(std::begin(range), std::end(range), value);
}

template <typename Range, typename Out, typename Test>
Out copy_if(Range&& range, Out out, Test test) {
  return std::copy_if(std::begin(range), std::end(range), out,
                      [&](auto&& element) { return std::invoke(test, element); });
}

}  // namespace ranges

template <typename Value>
requires requires(const Value& a) { a <=> a; }
constexpr auto operator<=>(const optional<Value>& a, const optional<Value>& b)
    -> decltype(*a <=> *b) {
  if (a && b) return *a <=> *b;
  return a.has_value() <=> b.has_value();
}

template <typename Value, size_t size>
requires requires(const Value& a) { a <=> a; }
constexpr auto operator<=>(const array<Value, size>& a, const array<Value, size>& b)
    -> decltype(a[0] <=> a[0]) {
  for (size_t i = 0; i < size; ++i) {
    if (const auto order = a[i] <=> b[i]; order != 0) return order;
  }
  return decltype(a[0] <=> b[0])(strong_ordering::equal);
}

}  // namespace std
#endif
