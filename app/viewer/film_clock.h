#pragma once

namespace relevo::viewer {

/// A position on the time line of a film, in frames from 0.
class FilmClock {
  public:
    /// Another film. The position stays at the same share of it.
    void set_film(int frames, double fps);
    int frames() const { return frames_; }
    double fps() const { return fps_; }
    int frame() const;
    double time_s() const { return frame() / fps_; }  ///< of the frame, from the film's beginning
    double length_s() const { return frames_ / fps_; }

    void go_to(int frame);
    bool is_playing() const { return is_playing_; }
    /// Plays on, from the beginning if the film is at its end.
    void play();
    void pause() { is_playing_ = false; }
    /// Moves by wall-clock time, over as many frames as pass in it. Pauses on the last frame.
    void advance(double passed_s);

  private:
    int frames_ = 1;
    double fps_ = 30;
    double at_ = 0;  // in frames
    bool is_playing_ = false;
};

}  // namespace relevo::viewer
