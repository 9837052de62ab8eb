#include "base/partial_names.h"

#include <array>
#include <atomic>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <mutex>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/random.h>
#include <unistd.h>

#include "base/error.h"
#include "base/output_file.h"

namespace relevo {
namespace {

constexpr std::size_t kNameLength = 8 + 16 + 5;  // ".relevo-", 64 bits in hexadecimal, ".part"

enum SlotState { kFree, kTaken, kActive };

/// What a signal handler can read: no heap, no locks.
struct Slot {
    std::atomic<int> state = kFree;
    int folder = -1;
    pid_t owner = 0;  ///< a child that was forked has a copy of the table, not the files
    std::array<char, kNameLength + 1> name{};
};

std::array<Slot, 64> slots;
static_assert(std::atomic<int>::is_always_lock_free);

extern "C" void remove_partial_files_and_end(int signal_number) {
    remove_partial_files();
    // SA_RESETHAND has put the signal's own end in place.
    raise(signal_number);
}

}  // namespace

PartialName::PartialName(int folder) : slot_(-1) {
    static std::once_flag at_exit;
    std::call_once(at_exit, [] { std::atexit([] { remove_partial_files(); }); });
    std::uint64_t random = 0;
    if (getrandom(&random, sizeof random, 0) != sizeof random) failed("getrandom: no randomness");
    for (std::size_t i = 0; i < slots.size() && slot_ < 0; ++i) {
        int expected = kFree;
        if (slots[i].state.compare_exchange_strong(expected, kTaken)) slot_ = static_cast<int>(i);
    }
    if (slot_ < 0) failed(fmt::format("more than {} files are being written", slots.size()));
    Slot& slot = slots[static_cast<std::size_t>(slot_)];
    slot.folder = folder;
    slot.owner = getpid();
    const std::string name = fmt::format(".relevo-{:016x}.part", random);
    name.copy(slot.name.data(), kNameLength);
    slot.state = kActive;
}

PartialName::~PartialName() {
    Slot& slot = slots[static_cast<std::size_t>(slot_)];
    if (slot.state == kActive && slot.owner == getpid()) unlinkat(slot.folder, slot.name.data(), 0);
    slot.state = kFree;
}

const char* PartialName::name() const {
    return slots[static_cast<std::size_t>(slot_)].name.data();
}

void PartialName::forget() {
    slots[static_cast<std::size_t>(slot_)].state = kTaken;
}

void remove_partial_files() noexcept {
    const pid_t self = getpid();
    for (Slot& slot : slots)
        if (slot.state == kActive && slot.owner == self) unlinkat(slot.folder, slot.name.data(), 0);
}

void remove_partial_files_at_signals() {
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGXCPU}) {
        struct sigaction action {};
        sigaction(number, nullptr, &action);
        if (action.sa_handler != SIG_DFL) continue;
        action.sa_handler = remove_partial_files_and_end;
        action.sa_flags = SA_RESETHAND;
        sigfillset(&action.sa_mask);
        sigaction(number, &action, nullptr);
    }
    std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace relevo
