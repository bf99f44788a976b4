/* tool_brush.h - brush tool: conversion of pointer input to strokes. */
#pragma once
#include "ui/app/state/app_state.h"

void wr_brush_press(WrApp *app, const WrPointer *at);
void wr_brush_drag(WrApp *app, const WrPointer *at);
void wr_brush_release(WrApp *app, const WrPointer *at);
/* Stabilizer: each point resulting from a motion is passed to `draw`. */
void wr_brush_steady_begin(WrApp *app, const WrPointer *at);
void wr_brush_steady_move(WrApp *app, const WrPointer *at,
                          void (*draw)(WrApp *app, const WrPointer *at));
void wr_brush_steady_end(WrApp *app, const WrPointer *at,
                         void (*draw)(WrApp *app, const WrPointer *at));
void wr_brush_resize(WrApp *app, const WrPointer *at);
void wr_brush_pick(WrApp *app, const WrPointer *at);
void wr_brush_options(WrApp *app);
