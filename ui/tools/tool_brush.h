/* tool_brush.h - the brush: gestures become strokes. */
#pragma once
#include "ui/state/app_state.h"

void wr_brush_press(WrApp *app, const WrPointer *at);
void wr_brush_drag(WrApp *app, const WrPointer *at);
void wr_brush_release(WrApp *app, const WrPointer *at);
/* The steadied hand: each point that comes out of a motion is given to `draw`. */
void wr_brush_steady_begin(WrApp *app, const WrPointer *at);
void wr_brush_steady_move(WrApp *app, const WrPointer *at,
                          void (*draw)(WrApp *app, const WrPointer *at));
void wr_brush_steady_end(WrApp *app, const WrPointer *at,
                         void (*draw)(WrApp *app, const WrPointer *at));
void wr_brush_resize(WrApp *app, const WrPointer *at);
void wr_brush_pick(WrApp *app, const WrPointer *at);
void wr_brush_options(WrApp *app);
