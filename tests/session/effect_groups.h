#pragma once

#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "session/picture_maker.h"
#include "session/session.h"
#include "support/device.h"

/// For tests of pictures that are drawn in parts, whatever effect is on.
namespace relevo::session {

/// Effects that are on besides the defaults. Those that do not hide each other share pictures.
using EffectGroup = std::vector<std::string>;

inline const std::vector<EffectGroup> kEffectGroups = {
    {},
    {"bloom", "occlusion", "contours", "grade", "wet"},
    {"snowfall", "tint", "vsm"},
    {"ridges", "swiss"},
    {"trees", "avalanche"}};  // with vsm, each part of a panorama has shadow maps of trees

inline std::string name_of(const testing::TestParamInfo<EffectGroup>& group) {
    return group.param.empty() ? "defaults" : fmt::format("{}", fmt::join(group.param, "_"));
}

/// Pictures of one session.
inline std::vector<image::Image8> pictures_of(const std::vector<scene::Scene>& scenes,
                                              const PictureFormat& format = {}) {
    FilesInUse files;
    Session session(scenes.front(),
                    {.device = test::gl_device(), .format = format, .allow_unmet = true}, files);
    std::vector<image::Image8> pictures;
    for (const scene::Scene& scene : scenes) {
        session.show(scene, session.time());
        pictures.push_back(std::get<image::Image8>(session.make_picture().pixels));
    }
    return pictures;
}

}  // namespace relevo::session
