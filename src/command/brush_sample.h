/* brush_sample.h - small relief pictures of brush presets: a stroke, lit from the upper left.

   Brushes that only change existing heights paint on a table of studs. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct WrBrushSample WrBrushSample;
typedef struct WrError WrError;
typedef struct WrPool WrPool;
typedef struct WrPreset WrPreset;

/* For pictures of width x height pixels; samples are 4:3, others are stretched. pool (borrowed) and isa as in wr_renderer_new. The
 * caller owns it. */
WrBrushSample *wr_brush_sample_new(WrPool *pool, const char *isa, int width, int height,
                                   WrError *err);
void wr_brush_sample_free(WrBrushSample *sample); /* NULL is allowed */
/* The preset's stroke as grey 8-bit sRGB, [height][width]. NULL: the round brush. */
bool wr_brush_sample_paint(WrBrushSample *sample, const WrPreset *preset, uint8_t *grey,
                           WrError *err);
