#pragma once

#include <cairo.h>

#include "chart/drawing.h"

namespace relevo::chart {

struct CairoDestroy {
    void operator()(cairo_t* cairo) const { cairo_destroy(cairo); }
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};

/// Draws all items, in the units of the context.
void draw_items(const Drawing& drawing, cairo_t* cairo);

}  // namespace relevo::chart
