/// The library never prints: it hands messages to a sink that the caller gives it.
#pragma once

#include <functional>
#include <string_view>

namespace pellucid {

enum class LogLevel { Info, Warning };

/// An empty sink drops the message.
using LogSink = std::function<void(LogLevel, std::string_view)>;

inline void logTo(const LogSink& sink, LogLevel level, std::string_view message) {
    if (sink) sink(level, message);
}

}  // namespace pellucid
