// Draws the ground from the sun, makes moments of its height, and says where in the map a point is.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <relevo/plugin.hpp>

namespace {

using namespace relevo::plugin;

/// Least sine of the sun's elevation for which heights are measured along the vertical. Below it a
/// ray hardly falls, and points along it hardly differ in height; there the axis leans to the sun.
constexpr double kLeastSine = 0.02;

/// Maps: one of all ground that is seen, and up to two of the ground that is nearer.
constexpr int kMaxLayers = 3;
/// A texel of a map is fine enough where it covers so many pixels, or so many posts.
constexpr double kEnough_px = 2, kEnoughPosts = 0.75;
/// Maps have fewer columns where texels would be finer than that many posts and so many pixels of
/// the nearest ground. Rows are not spared: how high they are is how shallow a shadow may be.
constexpr double kNarrow_px = 1.5;
constexpr int kColumnsStep = 128;
/// Columns are chosen anew once so small a share of them would do.
constexpr double kNarrower = 0.7;
/// A nearer map is worth its while if it has at most this share of the other's area.
constexpr double kWorthwhileShare = 0.25;
/// How far a map reaches beyond what is seen, as a share of that, so that it is kept for a while
/// when the camera moves.
constexpr double kMargin = 0.06;
/// A map is drawn anew once it is so many times as large as need be.
constexpr double kTooLarge = 4;
/// Texels come in so many sizes a doubling: the same ground has the same texels when a map is drawn
/// anew for nearly the same view.
constexpr double kSizesADoubling = 32;
/// The drawn ground may be off by so many rows: four times its root mean square error, so that most
/// of it stays within the bias.
constexpr double kTolerance_rows = 1.5;

glm::dvec3 vector_of(const double (&v)[3]) {
    return {v[0], v[1], v[2]};
}

void write(const glm::dvec3& from, double (&to)[3]) {
    for (int i = 0; i < 3; ++i)
        to[i] = from[i];
}

/// Directions in the light's own space. Its vertical lies in the upright plane of the sun: a low
/// sun sees the ground edgeways, and rows that are this close resolve it.
struct Axes {
    glm::dvec3 right{1, 0, 0}, up{0, 1, 0}, towards{0, 0, 1};
    glm::dvec3 rise{0, 0, 1};  ///< heights are products with this one; none to the right

    Axes() = default;
    explicit Axes(const glm::dvec3& to_sun) : towards(to_sun) {
        const glm::dvec3 level = cross(glm::dvec3(0, 0, 1), to_sun);
        right = length(level) > 1e-6 ? normalize(level) : glm::dvec3(1, 0, 0);
        up = cross(towards, right);
        rise = up.z * up + std::max(towards.z, kLeastSine) * towards;
    }
};

/// A rectangle across the light, in texels of some size.
struct Rectangle {
    glm::dvec2 low{0}, high{0};
    glm::dvec2 size() const { return high - low; }
    double area() const { return size().x * size().y; }
    bool holds(const Rectangle& other) const {
        return low.x <= other.low.x && low.y <= other.low.y && high.x >= other.high.x &&
               high.y >= other.high.y;
    }
};

/// The part of a box that is in another, which may hold less: both are around tiles of some level.
relevo_box within(relevo_box box, const relevo_box& other) {
    for (int i = 0; i < 3; ++i) {
        box.low[i] = std::max(box.low[i], other.low[i]);
        box.high[i] = std::min(box.high[i], other.high[i]);
    }
    return box;
}

Rectangle rectangle_of(const relevo_box& box) {
    return {{box.low[0], box.low[1]}, {box.high[0], box.high[1]}};
}

class Vsm : public Instance {
  public:
    explicit Vsm(const Host& host)
        : host_(host),
          log_(host),
          params_(host),
          frame_(host),
          terrain_(host),
          moments_program_(host, "moments.frag.glsl"),
          blur_program_(host, "blur.frag.glsl") {}

    void prepare() override {
        const relevo_frame frame = frame_.get();
        const auto size = static_cast<int>(params_.get("vsm.size"));
        const double blur = params_.get("vsm.blur");
        const glm::dvec3 to_sun = vector_of(frame.sun_apparent);
        if (size != size_ || blur != blur_ || to_sun != axes_.towards || frame.ground != ground_ ||
            frame.exaggeration != exaggeration_) {
            blur_ = blur;
            ground_ = frame.ground;
            exaggeration_ = frame.exaggeration;
            axes_ = Axes(to_sun);
            whole_ = box();
            terrain_.bounds(whole_);
            measure_heights();
            layers_.clear();
            if (size != size_) columns_ = 0;
            size_ = size;
        }
        if (params_.get("vsm.keep") == 0 || frame.afresh) layers_.clear();
        relevo_box seen = box();
        if (!terrain_.visible_bounds(1e300, seen)) seen = whole_;
        seen = within(seen, whole_);
        if (columns_ == 0 || layers_.empty() || is_stale(0, rectangle_of(seen)))
            choose_columns(seen, frame);
        const std::vector<Rectangle> needed = needed_rectangles(rectangle_of(seen), frame);
        if (static_cast<int>(needed.size()) > texture_layers_) {
            make_textures(kMaxLayers);
            layers_.clear();
        }
        layers_.resize(needed.size());
        for (std::size_t i = 0; i < needed.size(); ++i)
            if (is_stale(i, needed[i])) draw(i, fitted(needed[i]));
        write_params(frame);
    }

  private:
    relevo_box box() const {
        relevo_box box{};
        write(axes_.right, box.right);
        write(axes_.up, box.up);
        write(axes_.towards, box.towards);
        return box;
    }

    /// Along the rise: far from the DEM's centre the round Earth lies lower than its heights say.
    void measure_heights() {
        relevo_box upright = box();
        const glm::dvec3 rise = normalize(axes_.rise);
        write(cross(rise, axes_.right), upright.up);
        write(rise, upright.towards);
        terrain_.bounds(upright);
        lowest_m_ = upright.low[2] * length(axes_.rise);
        highest_m_ = upright.high[2] * length(axes_.rise);
        middle_m_ = 0.5 * (lowest_m_ + highest_m_);
    }

    bool is_stale(std::size_t layer, const Rectangle& needed) const {
        const Rectangle& drawn = layers_[layer];
        return !drawn.holds(needed) || drawn.area() > kTooLarge * fitted(needed).area();
    }

    glm::dvec2 texels() const { return {columns_, size_}; }

    void choose_columns(const relevo_box& seen, const relevo_frame& frame) {
        const glm::dmat3 axes(axes_.right, axes_.up, axes_.towards);
        const glm::dvec3 eye = vector_of(frame.eye_m) * axes;
        const glm::dvec3 apart = glm::max(
            glm::max(vector_of(seen.low) - eye, eye - vector_of(seen.high)), glm::dvec3(0));
        const double enough_m = std::min(kEnoughPosts * frame.post_spacing_m,
                                         kNarrow_px * frame.pixel_rad * length(apart));
        // As fitted() does, so that no texel is coarser than enough.
        const double across_m = (1 + 2 * kMargin) * rectangle_of(seen).size().x;
        const double columns =
            std::exp2(1 / kSizesADoubling) * across_m / std::max(enough_m, 1e-3) + 1;
        const int wanted = static_cast<int>(
            std::min(std::ceil(columns / kColumnsStep) * kColumnsStep, double(size_)));
        const double narrowest = frame.afresh ? 1 : kNarrower;
        if (wanted <= columns_ && wanted >= narrowest * columns_) return;
        columns_ = wanted;
        make_textures(1);
        layers_.clear();
    }

    /// Of a texel, on level ground [m].
    double ground_texel_m(const Rectangle& rectangle) const {
        const glm::dvec2 texel = rectangle.size() / texels();
        return std::max(texel.x, texel.y / std::max(axes_.towards.z, 5 * kLeastSine));
    }

    /// What has to be in each map: first of all that is seen, then of what is near enough to need
    /// finer texels.
    std::vector<Rectangle> needed_rectangles(const Rectangle& seen,
                                             const relevo_frame& frame) const {
        std::vector<Rectangle> result{seen};
        const auto most = static_cast<std::size_t>(params_.get("vsm.maps"));
        while (result.size() < most) {
            const double texel_m = ground_texel_m(fitted(result.back()));
            if (texel_m <= kEnoughPosts * frame.post_spacing_m) break;
            relevo_box near = box();
            if (!terrain_.visible_bounds(texel_m / (kEnough_px * frame.pixel_rad), near)) break;
            const Rectangle rectangle = rectangle_of(within(near, whole_));
            if (rectangle.area() > kWorthwhileShare * result.back().area()) break;
            result.push_back(rectangle);
        }
        return result;
    }

    /// With a margin where there is ground, on a grid of texels that stays where it is.
    Rectangle fitted(const Rectangle& needed) const {
        const Rectangle whole = rectangle_of(whole_);
        const glm::dvec2 margin = kMargin * needed.size();
        Rectangle wanted{glm::max(needed.low - margin, whole.low),
                         glm::min(needed.high + margin, whole.high)};
        Rectangle result;
        for (int i = 0; i < 2; ++i) {
            const double least_m = std::max(wanted.size()[i], 1.0) / (texels()[i] - 1);
            const double texel_m =
                std::exp2(std::ceil(std::log2(least_m) * kSizesADoubling) / kSizesADoubling);
            result.low[i] = std::floor(wanted.low[i] / texel_m) * texel_m;
            result.high[i] = result.low[i] + texels()[i] * texel_m;
        }
        return result;
    }

    void make_textures(int layers) {
        relevo_texture_info info{};
        info.width = columns_;
        info.height = size_;
        info.levels = 1;
        info.format = RELEVO_FORMAT_DEPTH32F;
        info.filter = RELEVO_FILTER_NEAREST;
        depth_ = Texture(host_, info);
        info.format = RELEVO_FORMAT_RG32F;
        rows_ = Texture(host_, info);
        info.name = "moments";
        info.layers = layers;
        info.filter = RELEVO_FILTER_LINEAR;
        moments_ = Texture(host_, info);
        texture_layers_ = layers;
    }

    void draw(std::size_t layer, const Rectangle& rectangle) {
        layers_[layer] = rectangle;
        relevo_box view = whole_;
        for (int i = 0; i < 2; ++i) {
            view.low[i] = rectangle.low[i];
            view.high[i] = rectangle.high[i];
        }
        const glm::dvec2 texel_m = rectangle.size() / texels();
        const int level = terrain_.draw_depth(view, kTolerance_rows * texel_m.y, depth_);

        const double along = dot(axes_.rise, axes_.up), deep = dot(axes_.rise, axes_.towards);
        const auto value = [](double a, double b, double c, double d) {
            return Program::Value{static_cast<float>(a), static_cast<float>(b),
                                  static_cast<float>(c), static_cast<float>(d)};
        };
        const Program::Value plane =
            value(0, along * texel_m.y, deep * (view.high[2] - view.low[2]),
                  along * view.low[1] + deep * view.low[2] - middle_m_);
        const Program::Value weights = value(1 - blur_, blur_ / 2, 0, 0);
        const Program::Value below = value(lowest_m_ - middle_m_, 1.0 / columns_, 1.0 / size_, 0);
        moments_program_.draw(rows_, 0, 0, {&depth_}, {plane, below, weights});
        blur_program_.draw(moments_, static_cast<int>(layer), 0, {&rows_}, {weights, below});
        log_.debug("vsm: map " + std::to_string(layer) + " drawn, texels of " +
                   std::to_string(texel_m.x) + " x " + std::to_string(texel_m.y) +
                   " m, ground of level " + std::to_string(level));
    }

    void write_params(const relevo_frame& frame) const {
        const Rectangle& all = layers_[0];
        const glm::dvec3 eye = vector_of(frame.eye_m);
        const auto set = [&](const char* address, const glm::dvec3& axis, double offset) {
            params_.set(address, {axis.x, axis.y, axis.z, offset});
        };
        set("vsm.across", axes_.right / all.size().x,
            (dot(axes_.right, eye) - all.low.x) / all.size().x);
        set("vsm.along", axes_.up / all.size().y, (dot(axes_.up, eye) - all.low.y) / all.size().y);
        set("vsm.rise", axes_.rise, dot(axes_.rise, eye) - middle_m_);
        std::array<double, 4> rounding{};
        constexpr std::array<const char*, kMaxLayers> kNames = {nullptr, "vsm.nearer",
                                                                "vsm.nearest"};
        for (std::size_t i = 0; i < kMaxLayers; ++i) {
            const bool there = i < layers_.size();
            const Rectangle& own = layers_[there ? i : 0];
            rounding[i] = own.size().y / size_;
            if (i == 0) continue;
            // Of the coordinates in the first map; without a map all lie outside.
            const glm::dvec2 scale = all.size() / own.size();
            const glm::dvec2 offset = (all.low - own.low) / own.size();
            params_.set(kNames[i], there ? std::array{scale.x, scale.y, offset.x, offset.y}
                                         : std::array{0.0, 0.0, -1.0, -1.0});
        }
        params_.set("vsm.row_m", rounding);
        params_.set("vsm.texel_m", {all.size().x / columns_, all.size().y / size_, 0, 0});
        const double sine = std::max(axes_.towards.z, kLeastSine);
        params_.set("vsm.reach",
                    {1 / sine / all.size().x, 1 / sine / all.size().y, highest_m_ - middle_m_, 0});
    }

    Host host_;
    Log log_;
    Params params_;
    Frame frame_;
    Terrain terrain_;
    Program moments_program_, blur_program_;
    Texture depth_, rows_, moments_;
    int texture_layers_ = 0;

    // What the maps were drawn with.
    int size_ = 0, columns_ = 0;
    double blur_ = -1, exaggeration_ = 0;
    double lowest_m_ = 0, middle_m_ = 0, highest_m_ = 0;
    std::uint64_t ground_ = 0;
    Axes axes_;
    relevo_box whole_{};
    std::vector<Rectangle> layers_;
};

}  // namespace

RELEVO_PLUGIN("vsm", Vsm)
