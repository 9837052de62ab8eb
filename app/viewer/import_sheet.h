#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "gl/texture.h"
#include "viewer/import_preview.h"
#include "viewer/settings.h"

namespace relevo::viewer {

/// Asks how a DEM is to be read: CRS, bounds, unit, nodata, band, encoding, with a preview. For
/// files that do not say it, and later for those that say it wrongly. While CRSs are listed, the
/// preview is of the highlighted one.
class ImportSheet {
  public:
    /// Shows the sheet.
    /// @param reason  why it is needed; may be empty
    /// @param other   the DEM that was opened last, for suggestions; may have no files
    void open(const RecentDem& dem, std::string reason, const RecentDem& other);
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
    void search();
    void crs_list();
    /// CRSs to choose from: those found, or suggestions as long as the field is empty.
    const std::vector<CrsSuggestion>& listed() const {
        return fields_.crs.empty() ? suggestions_ : found_;
    }
    /// Whether the field has no CRS yet of those that are listed.
    bool is_choosing() const {
        return !listed().empty() && listed().front().crs.code != fields_.crs;
    }
    /// The fields with the highlighted CRS.
    Fields highlighted() const;
    void other_fields();
    void take_preview();
    void preview(float width_px);
    void want_preview();
    /// Whether the preview is of what would be opened, and that can be.
    bool can_open() const;
    void buttons();
    void choose();

    RecentDem dem_, other_;
    std::string reason_, error_;
    Fields fields_;
    std::optional<Fields> previewed_;
    std::string searched_;  // of found_
    std::vector<CrsSuggestion> found_, suggestions_;
    int selected_ = 0;  // of listed()
    bool takes_focus_ = false;
    std::unique_ptr<PreviewWork> work_;  // from the first open()
    PreviewWanted wanted_;               // of previewed_
    std::shared_ptr<const Preview> shown_;
    gl::Texture texture_;  // of shown_
    bool is_open_ = false;
    std::optional<RecentDem> chosen_;
};

}  // namespace relevo::viewer
