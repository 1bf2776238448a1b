// What an autopilot's log holds, for people and for programs.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "tethercalc/io/log_summary.hpp"
#include "tethercalc/report/text_table.hpp"

namespace tethercalc {

/// The summary as text to read, ending with a line end; `name` is the log's.
[[nodiscard]] std::string log_text(const LogSummary& summary, std::string_view name,
                                   const TextStyle& style = {});

/// The summary's table of messages as CSV: `name,count,rate_Hz,first_s,last_s,longest_gap_s`, with
/// empty cells where a message carries no time.
[[nodiscard]] std::string log_csv(const LogSummary& summary);

/// The summary as JSON: `file, format` (`dataflash`, `dataflash_text` or `ulog`), `bytes, messages,
/// firmware, vehicle` (or null), `first_s, last_s, duration_s, flying` {`duration_s, determined_by,
/// flights` [{`start_s, end_s`}…]} or null, `batteries` [{`message, instance, samples, voltage_V`
/// {`least, mean, greatest`}, `current_A` {`mean, greatest`} or null, `energy_Wh` or null}…],
/// `wind`
/// {`message, speed_m_s, from_deg`} or null, `uses` [{`command, possible, because`}…], `gaps`
/// [{`start_s, duration_s`}…], `gap_count, dropouts` [{`after_s, duration_s`}…],
/// `implausible_times, skipped` {`bytes, messages, stretches` [{`offset, bytes, messages`}…]},
/// `rejected_definitions, types` [{`name, count, rate_Hz, first_s, last_s, longest_gap_s,
/// instances, fields, units`}…]. Times are null where there are none.
[[nodiscard]] nlohmann::ordered_json log_json(const LogSummary& summary, std::string_view name);

/// Gives all messages called `message` to `put` as lines of CSV, one at a time, so that an export
/// may be larger than the memory: a header, then one row a message in the log's order, one column a
/// field, named as in the log; before them `instance` where the log has several in one name.
/// Numbers as field_text() gives them, with an empty cell for what is not finite; text is quoted
/// where it has to be (RFC 4180). Each line ends with a newline.
///
/// Throws InputError naming the log where there is no such message in it, with the
/// closest one that there is; `put` has not been called then.
void messages_csv(const AutopilotLog& log, std::string_view message,
                  const std::function<void(std::string_view line)>& put);

}  // namespace tethercalc
