#include "call.h"

#include <atomic>
#include <cstdio>
#include <exception>
#include <mutex>
#include <new>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include "base/error.h"
#include "base/host_program.h"
#include "base/log.h"
#include "base/text.h"

namespace relevo::c {
namespace {

std::string& error_text() {
    thread_local std::string text;
    return text;
}

relevo_result code_of(ErrorCode code) {
    switch (code) {
        case ErrorCode::Usage:
        case ErrorCode::BadInput:
            return RELEVO_RESULT_BAD_INPUT;
        case ErrorCode::NoDevice:
            return RELEVO_RESULT_NO_DEVICE;
        default:
            return RELEVO_RESULT_FAILED;
    }
}

/// The code of the exception that is being handled, and what it says.
relevo_result explain(const char* function, std::string& message) {
    try {
        throw;
    } catch (const Error& error) {
        message = error.what();
        return code_of(error.code());
    } catch (const BadCall& bad) {
        message = fmt::format("{}: {}", function, bad.message);
        return RELEVO_RESULT_BAD_CALL;
    } catch (const Cancelled&) {
        message = fmt::format("{}: cancelled", function);
        return RELEVO_RESULT_CANCELLED;
    } catch (const CallbackThrew& threw) {
        message = fmt::format("{}: {}: the callback threw an exception", function, threw.which);
        return RELEVO_RESULT_FAILED;
    } catch (const std::bad_alloc&) {
        message = fmt::format("{}: out of memory", function);
        return RELEVO_RESULT_OUT_OF_MEMORY;
    } catch (const std::length_error&) {
        message = fmt::format("{}: out of memory", function);
        return RELEVO_RESULT_OUT_OF_MEMORY;
    } catch (const std::exception& error) {
        message = fmt::format("{}: {}", function, error.what());
        return RELEVO_RESULT_FAILED;
    } catch (...) {
        message = fmt::format("{}: an unknown exception", function);
        return RELEVO_RESULT_FAILED;
    }
}

/// Until relevo_set_message() is called.
void warn_on_standard_error(log::Level level, std::string_view text) {
    if (level == log::Level::Warning || level == log::Level::Error)
        std::fprintf(stderr, "relevo: warning: %s\n", printable(text).c_str());
}

}  // namespace

relevo_result code_of_exception(const char* function) noexcept {
    try {
        std::string message;
        const relevo_result code = explain(function, message);
        error_text() = std::move(message);
        return code;
    } catch (...) {
        error_text().clear();  // there is no memory for the message
        return RELEVO_RESULT_OUT_OF_MEMORY;
    }
}

void prepare_library() {
    static std::once_flag once;
    std::call_once(once, [] {
        log::set_sink(warn_on_standard_error);
        set_hosted();
    });
}

const char* returned_text(std::string text) {
    thread_local std::string kept;
    kept = std::move(text);
    return kept.c_str();
}

void check_count(const char* name, std::size_t count, std::size_t needed) {
    if (count != needed)
        throw BadCall{fmt::format("{}: expected {} elements but got {}", name, needed, count)};
}

void Progress::add(double share) {
    done_ = std::min(1.0, done_ + share);
    if (given_.share) std::atomic_ref(*given_.share) = done_;
    if (given_.cancel && std::atomic_ref(*given_.cancel) != 0) throw Cancelled();
    if (!given_.done) return;
    bool cancelled = false;
    try {
        cancelled = given_.done(given_.user, done_) != 0;
    } catch (...) {
        throw CallbackThrew{"progress"};
    }
    if (cancelled) throw Cancelled();
}

}  // namespace relevo::c

using namespace relevo;

const char* relevo_version(void) {
    return RELEVO_VERSION;
}

const char* relevo_error(void) {
    return c::error_text().c_str();
}

relevo_result relevo_set_message(relevo_message message, void* user) {
    return c::guarded("relevo_set_message", [&] {
        log::set_level(message ? log::Level::Debug : log::Level::Info);
        if (!message) return log::set_sink(c::warn_on_standard_error);
        log::set_sink([message, user](log::Level level, std::string_view text) {
            const int32_t number = level == log::Level::Debug  ? RELEVO_MESSAGE_DEBUG
                                   : level == log::Level::Info ? RELEVO_MESSAGE_INFO
                                                               : RELEVO_MESSAGE_WARNING;
            try {
                message(user, number, std::string(text).c_str());
            } catch (...) {
                // Messages are no reason to end a call.
            }
        });
    });
}
