#include "render/background_linker.h"

#include <exception>

#include "base/log.h"

namespace relevo::render {

BackgroundLinker::BackgroundLinker(const gl::Context& context, std::vector<ProgramText> texts,
                                   std::vector<const shader::Snippet*> snippets)
    : context_(context), texts_(std::move(texts)), snippets_(std::move(snippets)) {
    if (!texts_.empty()) thread_ = std::thread([this] { run(); });
}

BackgroundLinker::~BackgroundLinker() {
    ends_ = true;
    if (thread_.joinable()) thread_.join();
}

std::vector<std::pair<std::string, gl::Program>> BackgroundLinker::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(linked_, {});
}

void BackgroundLinker::run() {
    try {
        gl::Context context = gl::Context::sharing(context_);
        DrawWatch watch(snippets_);
        for (const ProgramText& text : texts_)
            if (!ends_) link(text, context, watch);
    } catch (const std::exception& error) {
        log::debug(error.what());
    }
}

void BackgroundLinker::link(const ProgramText& text, gl::Context& context, DrawWatch& watch) {
    try {
        const DrawWatch::Turn turn(watch, text, 0);
        gl::Program program = link_program(text);
        context.finish();  // makes the program visible to other contexts
        const std::lock_guard lock(mutex_);
        linked_.emplace_back(text.hash, std::move(program));
    } catch (const std::exception& error) {
        log::debug(error.what());
    }
}

}  // namespace relevo::render
