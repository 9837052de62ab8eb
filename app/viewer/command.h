#pragma once

#include <optional>

namespace relevo::viewer {

struct KeyPress;

/// What keys and menus have the window do.
enum class Command {
    Open,
    HowToRead,  ///< CRS, unit and so on of the DEM
    NextFile,
    PreviousFile,
    ReadAgain,
    TakePicture,
    ExportPicture,  ///< asks how
    CopyCommand,
    SaveScene,
    SaveJob,
    Film,  ///< its panel
    Quit,
    Undo,
    Redo,
    Whole,
    NorthUp,
    FromAbove,
    Find,  ///< a place
    Walk,
    StandHere,  ///< at the chosen point
    LookThere,  ///< to the chosen point
    LookToMoon,
    SunOverPoint,  ///< when it next stands over the chosen point, seen from here
    MoonOverPoint,
    NextMoonrise,  ///< by night, over the ground around
    SaveView,
    Measure,  ///< begins or ends a line
    EndMeasuring,
    DropCorner,  ///< of the measured line
    SaveProfile,
    Compare,
    Play,
    Now,
    Earlier,
    Later,
    DayEarlier,
    DayLater,
    Panels,
    PanelKeys,  ///< gives the keyboard to the panels, or back to the scene
    MenuKeys,   ///< gives it to the menu
    Charts,
    Keys,  ///< a sheet of help, like the next two
    FirstSteps,
    About,
    Close,  ///< what is open: a sheet, a measured line, a message
    Overlay,
    SaveOverlay,
    GiveUpSaving,
};

std::optional<Command> command_of(const KeyPress& press);

}  // namespace relevo::viewer
