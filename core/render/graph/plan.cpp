#include "render/graph/plan.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"

namespace relevo::render {
namespace {

using Mode = Access::Mode;

[[noreturn]] void refuse(const std::string& message) {
    failed("render: graph: " + message);
}

class Planner {
  public:
    explicit Planner(const FrameGraph& graph)
        : graph_(graph), followers_(graph.passes.size()), chains_(graph.resources.size()) {}

    Plan run() {
        name();
        for (std::size_t p = 0; p < graph_.passes.size(); ++p)
            check(static_cast<int>(p));
        for (std::size_t r = 0; r < graph_.resources.size(); ++r)
            order_writers(static_cast<int>(r));
        order_readers();
        const std::vector<int> order = sorted();
        find_live();
        for (const int pass : order)
            if (live_.contains(pass)) add_step(pass);
        share_memory();
        find_barriers();
        return std::move(plan_);
    }

  private:
    void add_step(int pass) {
        plan_.steps.push_back({.pass = pass});
        for (const Access& access : accesses_[static_cast<std::size_t>(pass)])
            if (access.mode == Mode::Read) plan_.read.insert(access.version.resource);
    }

    const Pass& pass(int index) const { return graph_.passes[static_cast<std::size_t>(index)]; }
    const Resource& resource(int index) const {
        return graph_.resources[static_cast<std::size_t>(index)];
    }
    const std::vector<int>& chain(int resource) const {
        return chains_[static_cast<std::size_t>(resource)];
    }

    void name() {
        for (const Resource& each : graph_.resources)
            if (!resources_.emplace(each.name, static_cast<int>(resources_.size())).second)
                refuse(fmt::format("two resources are called {}", each.name));
        for (const Pass& each : graph_.passes)
            if (!passes_.emplace(each.name, static_cast<int>(passes_.size())).second)
                refuse(fmt::format("two passes are called {}", each.name));
    }

    int resource_of(const Pass& of, const Access& access) const {
        const auto known = resources_.find(access.version.resource);
        if (known == resources_.end())
            refuse(fmt::format("pass {} names {}, which is no resource", of.name,
                               access.version.resource));
        return known->second;
    }

    /// Rejects declarations with undefined or no effect.
    static void check_kind(const Pass& of) {
        const auto refuse_if = [&](bool wrong, std::string_view what) {
            if (wrong) refuse(fmt::format("pass {} {}", of.name, what));
        };
        const bool fullscreen = of.kind == PassKind::Fullscreen;
        const bool computes = of.kind == PassKind::Compute;
        refuse_if(of.name == "before" || of.name.find('@') != std::string::npos,
                  "has a name that means a version");
        refuse_if(fullscreen && of.body, "is full-screen and has a body");
        refuse_if(computes && of.body, "is compute and has a body");
        refuse_if(!fullscreen && !computes && !of.body, "has no body");
        refuse_if(computes != of.dispatch.has_value(), computes
                                                           ? "is compute and has no work groups"
                                                           : "has work groups and is not compute");
        refuse_if(computes && (of.writes.size() != 1 || !of.updates.empty() ||
                               !of.colours.empty() || of.depth || of.stencil),
                  "is compute and does not write one image or buffer");
        refuse_if(of.kind != PassKind::Host && of.program.empty(), "has no program");
        refuse_if(of.depth && of.stencil, "has both a depth and a stencil");
        refuse_if(of.depth && of.depth->clear && !of.depth->writes, "clears a depth that it reads");
        for (const Colour& colour : of.colours) {
            refuse_if(colour.updates && colour.clear, "clears what it updates");
            refuse_if(!Version::of(colour.resource).pass.empty(), "draws into a version");
        }
    }

    /// Checks a pass in isolation.
    void check(int index) {
        const Pass& of = pass(index);
        check_kind(of);
        accesses_.push_back(accesses(of));
        std::map<int, Mode> modes;
        for (const Access& access : accesses_.back()) {
            const int r = resource_of(of, access);
            const auto [first, fresh] = modes.emplace(r, access.mode);
            if (!fresh && (access.mode != Mode::Read || first->second != Mode::Read))
                refuse(fmt::format("pass {} both reads {} and draws into it", of.name,
                                   resource(r).name));
            if (of.when != When::Frame && resource(r).lifetime == Lifetime::Frame)
                refuse(
                    fmt::format("pass {} is not executed in every frame but uses {}, which "
                                "lasts for one frame",
                                of.name, resource(r).name));
            if (access.mode != Mode::Read) chains_[static_cast<std::size_t>(r)].push_back(index);
        }
    }

    /// True if `after` orders one pass behind another, directly or indirectly.
    bool is_after(int later, int earlier) const {
        std::vector<int> open{later};
        std::set<int> seen;
        while (!open.empty()) {
            const int at = open.back();
            open.pop_back();
            for (const std::string& name : pass(at).after) {
                const auto known = passes_.find(name);
                if (known == passes_.end() || !seen.insert(known->second).second) continue;
                if (known->second == earlier) return true;
                open.push_back(known->second);
            }
        }
        return false;
    }

    Mode mode(int by, int resource) const {
        for (const Access& access : accesses_[static_cast<std::size_t>(by)])
            if (resources_.at(access.version.resource) == resource && access.mode != Mode::Read)
                return access.mode;
        return Mode::Read;
    }

    void add_edge(int earlier, int later) {
        if (earlier != later) followers_[static_cast<std::size_t>(earlier)].insert(later);
    }

    /// Sorts the writer and the updates of a resource.
    void order_writers(int r) {
        std::vector<int>& all = chains_[static_cast<std::size_t>(r)];
        std::ranges::stable_partition(all, [&](int by) { return mode(by, r) == Mode::Write; });
        const auto updates =
            std::ranges::find_if(all, [&](int by) { return mode(by, r) == Mode::Update; });
        if (updates - all.begin() > 1)
            refuse(fmt::format("passes {} and {} both write {}", pass(all[0]).name,
                               pass(all[1]).name, resource(r).name));
        if (updates == all.begin() && !all.empty() && resource(r).lifetime == Lifetime::Frame)
            refuse(fmt::format("pass {} draws over {}, which no pass writes", pass(all[0]).name,
                               resource(r).name));
        for (auto a = updates; a != all.end(); ++a)
            for (auto b = a + 1; b != all.end(); ++b)
                if (!is_after(*a, *b) && !is_after(*b, *a))
                    refuse(
                        fmt::format("passes {} and {} both draw over {} in no order: one has to "
                                    "name the other in `after`",
                                    pass(*a).name, pass(*b).name, resource(r).name));
        std::sort(updates, all.end(), [&](int a, int b) { return is_after(b, a); });
        for (std::size_t i = 1; i < all.size(); ++i)
            add_edge(all[i - 1], all[i]);
    }

    /// Number of a resource's writers that precede a reader.
    std::size_t seen_by(const Pass& reader, const Version& version, int r) const {
        const std::vector<int>& writers = chain(r);
        const bool provided = resource(r).lifetime == Lifetime::Provided;
        if (version.is_before()) {
            if (resource(r).lifetime == Lifetime::Frame)
                refuse(fmt::format("pass {} reads {}@before, which lasts for one frame",
                                   reader.name, version.resource));
            return 0;
        }
        if (writers.empty() && !provided)
            refuse(fmt::format("pass {} reads {}, which no pass writes", reader.name,
                               version.resource));
        if (version.pass.empty()) return writers.size();
        for (std::size_t i = 0; i < writers.size(); ++i)
            if (pass(writers[i]).name == version.pass) return i + 1;
        refuse(fmt::format("pass {} reads {}@{}, but {} does not write {}", reader.name,
                           version.resource, version.pass, version.pass, version.resource));
    }

    void order_readers() {
        for (int p = 0; p < static_cast<int>(graph_.passes.size()); ++p) {
            for (const std::string& name : pass(p).after)
                if (const auto known = passes_.find(name); known != passes_.end())
                    add_edge(known->second, p);
            for (const Access& access : accesses_[static_cast<std::size_t>(p)]) {
                if (access.mode != Mode::Read) continue;
                const int r = resources_.at(access.version.resource);
                const std::size_t seen = seen_by(pass(p), access.version, r);
                if (seen > 0) add_edge(chain(r)[seen - 1], p);
                if (seen < chain(r).size()) add_edge(p, chain(r)[seen]);
            }
        }
    }

    std::vector<int> sorted() const {
        std::vector<int> waits(graph_.passes.size(), 0);
        for (const std::set<int>& followers : followers_)
            for (const int follower : followers)
                ++waits[static_cast<std::size_t>(follower)];
        std::set<int> ready;
        for (int p = 0; p < static_cast<int>(waits.size()); ++p)
            if (waits[static_cast<std::size_t>(p)] == 0) ready.insert(p);
        std::vector<int> order;
        while (!ready.empty()) {
            const int next = *ready.begin();
            ready.erase(ready.begin());
            order.push_back(next);
            for (const int follower : followers_[static_cast<std::size_t>(next)])
                if (--waits[static_cast<std::size_t>(follower)] == 0) ready.insert(follower);
        }
        if (order.size() == waits.size()) return order;
        std::vector<std::string> names;
        for (std::size_t p = 0; p < waits.size(); ++p)
            if (waits[p] > 0) names.push_back(graph_.passes[p].name);
        refuse(fmt::format("passes {} wait for each other", fmt::join(names, ", ")));
    }

    void find_live() {
        std::vector<int> open;
        const auto need = [&](int p) {
            if (live_.insert(p).second) open.push_back(p);
        };
        for (std::size_t r = 0; r < chains_.size(); ++r)
            if (graph_.resources[r].output) std::ranges::for_each(chains_[r], need);
        while (!open.empty()) {
            const int p = open.back();
            open.pop_back();
            for (const Access& access : accesses_[static_cast<std::size_t>(p)]) {
                const int r = resources_.at(access.version.resource);
                const std::vector<int>& writers = chain(r);
                std::size_t needed = writers.size();
                if (access.mode != Mode::Read)
                    needed =
                        static_cast<std::size_t>(std::ranges::find(writers, p) - writers.begin());
                else if (!access.version.is_before())
                    needed = seen_by(pass(p), access.version, r);
                std::for_each_n(writers.begin(), needed, need);
            }
        }
    }

    /// First and last step that use a resource; {-1, -1} if unused.
    std::pair<int, int> span(int r) const {
        std::pair<int, int> found{-1, -1};
        for (int s = 0; s < static_cast<int>(plan_.steps.size()); ++s) {
            for (const Access& access : accesses_of(s)) {
                if (resources_.at(access.version.resource) != r) continue;
                if (found.first < 0) found.first = s;
                found.second = s;
            }
        }
        return found;
    }

    const std::vector<Access>& accesses_of(int step) const {
        return accesses_[static_cast<std::size_t>(
            plan_.steps[static_cast<std::size_t>(step)].pass)];
    }

    static bool may_share(const Resource& a, const Resource& b) {
        return a.kind == b.kind && a.format == b.format && a.size == b.size && a.linear == b.linear;
    }

    void share_memory() {
        const auto count = static_cast<int>(graph_.resources.size());
        plan_.memory_of.assign(graph_.resources.size(), -1);
        std::vector<int> order, free_after;  // for each memory: last step that uses it
        std::vector<std::pair<int, int>> spans;
        for (int r = 0; r < count; ++r) {
            spans.push_back(span(r));
            if (spans.back().first >= 0 && resource(r).lifetime != Lifetime::Provided)
                order.push_back(r);
        }
        std::ranges::stable_sort(order, {},
                                 [&](int r) { return spans[static_cast<std::size_t>(r)].first; });
        constexpr int kNever = 1 << 30;
        for (const int r : order) {
            const auto [first, last] = spans[static_cast<std::size_t>(r)];
            const bool lasts = resource(r).lifetime == Lifetime::Kept || resource(r).output;
            std::size_t m = 0;
            while (m < plan_.memory.size() &&
                   (lasts || free_after[m] >= first ||
                    !may_share(resource(plan_.memory[m].resources.front()), resource(r))))
                ++m;
            if (m == plan_.memory.size()) {
                plan_.memory.emplace_back();
                free_after.push_back(0);
            }
            plan_.memory[m].resources.push_back(r);
            free_after[m] = lasts ? kNever : last;
            plan_.memory_of[static_cast<std::size_t>(r)] = static_cast<int>(m);
            if (resource(r).lifetime == Lifetime::Frame)
                plan_.steps[static_cast<std::size_t>(first)].begins.push_back(r);
        }
    }

    void find_barriers() {
        // Compute writes of the previous frame are not synchronised yet.
        std::set<int> incoherent;
        const auto add_writes = [&](int step) {
            if (pass(plan_.steps[static_cast<std::size_t>(step)].pass).kind != PassKind::Compute)
                return;
            for (const Access& access : accesses_of(step))
                if (access.mode != Mode::Read)
                    incoherent.insert(resources_.at(access.version.resource));
        };
        const auto steps = static_cast<int>(plan_.steps.size());
        for (int s = 0; s < steps; ++s)
            add_writes(s);
        for (int s = 0; s < steps; ++s) {
            bool& barrier = plan_.steps[static_cast<std::size_t>(s)].barrier;
            for (const Access& access : accesses_of(s))
                barrier |= incoherent.contains(resources_.at(access.version.resource));
            if (barrier) incoherent.clear();
            add_writes(s);
        }
    }

    const FrameGraph& graph_;
    std::map<std::string, int> resources_, passes_;
    std::vector<std::vector<Access>> accesses_;  // of each pass
    std::vector<std::set<int>> followers_;       // by pass: passes that must follow it
    std::vector<std::vector<int>> chains_;       // by resource: its writer, then its updates
    std::set<int> live_;
    Plan plan_;
};

}  // namespace

Plan plan(const FrameGraph& graph) {
    return Planner(graph).run();
}

}  // namespace relevo::render
