#include "session/data_layers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>

#include "base/error.h"
#include "base/parallel_for.h"
#include "base/text.h"
#include "session/seen_ground.h"
#include "session/session.h"

namespace relevo::session {
namespace {

// In the order of DataLayer.
const std::vector<std::string> kWords = {"depth", "normal", "position", "shadow", "albedo", "ids"};

enum Kind { kNothing = 0, kGround = 1, kWater = 2, kWall = 3 };

class Layers {
  public:
    Layers(const render::PixelData& data, const LayerView& view, const LoadedDem& dem,
           const geo::LocalFrame& frame)
        : data_(data), view_(view), dem_(dem), frame_(frame) {}

    void add(DataLayer layer, std::vector<image::Channel>& to) const {
        switch (layer) {
            case DataLayer::Depth:
                to.push_back({.name = "depth.Z", .values = data_.depths_m});
                return;
            case DataLayer::Normal:
                return add_vector("normal", to, [&](std::size_t i) { return data_.normals[i]; });
            case DataLayer::Position:
                return add_vector("position", to,
                                  [&](std::size_t i) { return glm::vec3(position_m(i)); });
            case DataLayer::Shadow:
                to.push_back({.name = "shadow.Y", .values = data_.sun});
                return;
            case DataLayer::Albedo:
                return add_vector(
                    "albedo", to, [&](std::size_t i) { return data_.albedo[i]; }, "RGB");
            case DataLayer::Ids:
                to.push_back(ids());
                return;
        }
    }

  private:
    template <typename Vector>
    void add_vector(const std::string& name, std::vector<image::Channel>& to, const Vector& vector,
                    const char* axes = "XYZ") const {
        for (int axis = 0; axis < 3; ++axis) {
            image::Channel channel{.name = fmt::format("{}.{}", name, axes[axis])};
            channel.values.resize(data_.depths_m.size());
            for (std::size_t i = 0; i < channel.values.size(); ++i)
                channel.values[i] = vector(i)[axis];
            to.push_back(std::move(channel));
        }
    }

    /// In the local frame; NaN where there is no ground.
    glm::dvec3 position_m(std::size_t pixel) const {
        const double depth_m = data_.depths_m[pixel];
        if (!std::isfinite(depth_m)) return glm::dvec3(std::nan(""));
        const auto width = static_cast<std::size_t>(view_.size_px.x);
        const auto x = static_cast<double>(pixel % width), y = static_cast<double>(pixel / width);
        const glm::dvec2 at(view_.corner_px.x + x + 0.5,
                            view_.picture_px.y - view_.corner_px.y - view_.size_px.y + y + 0.5);
        return SeenGround::at(view_.camera, at, view_.picture_px, depth_m);
    }

    image::Channel ids() const {
        image::Channel channel{.name = "ids.kind", .is_whole = true};
        channel.values.resize(data_.depths_m.size());
        const auto width = static_cast<std::size_t>(view_.size_px.x);
        parallel_for(0, view_.size_px.y, 16, [&](int first, int last) {
            for (std::size_t i = width * static_cast<std::size_t>(first);
                 i < width * static_cast<std::size_t>(last); ++i)
                channel.values[i] = static_cast<float>(kind_of(i));
        });
        return channel;
    }

    Kind kind_of(std::size_t pixel) const {
        if (!std::isfinite(data_.depths_m[pixel])) return kNothing;
        if (data_.walls[pixel]) return kWall;
        const Array2d<dem::WaterKind>& water = dem_.drawn.water.kind;
        if (water.empty()) return kGround;
        const glm::dvec2 post = dem_.to_draw().grid.post(frame_.to_geodetic(position_m(pixel)));
        if (!std::isfinite(post.x + post.y)) return kGround;
        const int x = std::clamp(static_cast<int>(std::lround(post.x)), 0, water.width() - 1);
        const int y = std::clamp(static_cast<int>(std::lround(post.y)), 0, water.height() - 1);
        return water.at(x, y) == dem::WaterKind::None ? kGround : kWater;
    }

    const render::PixelData& data_;
    const LayerView& view_;
    const LoadedDem& dem_;
    const geo::LocalFrame& frame_;
};

}  // namespace

const std::string& word_of(DataLayer layer) {
    return kWords[static_cast<std::size_t>(layer)];
}

std::vector<DataLayer> parse_layers(const std::vector<std::string>& words, const std::string& who) {
    std::vector<DataLayer> layers;
    for (const std::string& word : words == std::vector<std::string>{"all"} ? kWords : words) {
        const auto found = std::ranges::find(kWords, word);
        if (found == kWords.end())
            bad_input(fmt::format("{}: {}: expected all or a list of {}", who, printable(word),
                                  fmt::join(kWords, ", ")));
        const auto layer = static_cast<DataLayer>(found - kWords.begin());
        if (std::ranges::find(layers, layer) == layers.end()) layers.push_back(layer);
    }
    return layers;
}

std::vector<image::Channel> channels_of(const std::vector<DataLayer>& layers,
                                        const render::PixelData& data, const LayerView& view,
                                        const LoadedDem& dem, const geo::LocalFrame& frame) {
    const Layers of(data, view, dem, frame);
    std::vector<image::Channel> channels;
    for (const DataLayer layer : layers)
        of.add(layer, channels);
    return channels;
}

}  // namespace relevo::session
