#pragma once

#include <chrono>
#include <string>

#include <nlohmann/json.hpp>

#include "base/output_file.h"
#include "session/session.h"

namespace relevo::cli {

using Clock = std::chrono::steady_clock;
double milliseconds_since(Clock::time_point began);

/// What `--timings` writes: each stage of a run, and the further frames of `--repeat`.
class Timings {
  public:
    /// @param file  null: nothing is written
    explicit Timings(OutputFile* file) : file_(file) {}

    bool wanted() const { return file_ != nullptr; }
    render::PassTimes* passes() { return file_ ? &passes_ : nullptr; }
    void add(const std::string& stage, double took_ms) { stages_[stage] = took_ms; }
    /// Of the whole picture: its first frame's passes, and what comes after them.
    void add_picture(double took_ms);

    /// @param repeat  further frames, each also with its passes timed and with the sun moved
    void write(session::Session& session, int repeat);

  private:
    OutputFile* file_;
    Clock::time_point began_ = Clock::now();
    nlohmann::ordered_json stages_ = nlohmann::ordered_json::object();
    render::PassTimes passes_;
};

}  // namespace relevo::cli
