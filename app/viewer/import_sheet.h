#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "geo/crs_search.h"
#include "gl/texture.h"
#include "viewer/import_preview.h"
#include "viewer/settings.h"

namespace relevo::viewer {

/// Asks how a DEM is to be read: CRS, bounds, unit, nodata, band, encoding, with a preview. For
/// files that do not say it, and later for those that say it wrongly.
class ImportSheet {
  public:
    /// Shows the sheet. @param reason  why it is needed; may be empty
    void open(const RecentDem& dem, std::string reason);
    void close() { is_open_ = false; }
    bool is_open() const { return is_open_; }
    /// @param size_px  of the window
    void draw(glm::vec2 size_px);
    /// The DEM that the user has asked for since the last call, with its options.
    std::optional<RecentDem> take() { return std::exchange(chosen_, std::nullopt); }

  private:
    /// The fields as the user writes them.
    struct Fields {
        std::string crs, bounds, crop, unit, nodata;
        int band = 0;
        int encoding = 0;  ///< index of a dem::Encoding

        bool operator==(const Fields&) const = default;
        static Fields of(const dem::LoadOptions& options);
        /// @throws Error (Usage, BadInput) with the name of the field
        dem::LoadOptions options(const dem::LoadOptions& rest) const;
    };

    void crs_field();
    void found_crs();
    bool is_found_chosen() const { return !found_.empty() && found_.front().code == fields_.crs; }
    void other_fields();
    void preview(float width_px);
    void want_preview();

    RecentDem dem_;
    std::string reason_, error_;
    Fields fields_;
    std::optional<Fields> previewed_;
    std::string searched_;  // of found_
    std::vector<geo::KnownCrs> found_;
    std::unique_ptr<PreviewWork> work_;  // from the first open()
    std::shared_ptr<const Preview> shown_;
    gl::Texture texture_;  // of shown_
    bool is_open_ = false;
    std::optional<RecentDem> chosen_;
};

}  // namespace relevo::viewer
