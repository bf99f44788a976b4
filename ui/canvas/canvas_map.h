/* canvas_map.h - a map of the table (field/maps.h) in the table's place on the canvas: made in the background, kept up to date
   by the tiles that an edit can reach. Tested without a window. All calls come from the window's thread. */
#pragma once
#include "field/maps.h"

#include <SDL.h>
#include <stdbool.h>

typedef struct WrField WrField;

typedef struct WrCanvasMap WrCanvasMap;

/* threads: as in wr_pool_new. done_event: an SDL event type, pushed when tiles are there. */
WrCanvasMap *wr_canvas_map_new(int threads, Uint32 done_event);
void wr_canvas_map_free(WrCanvasMap *map); /* NULL is fine */

/* The newest map of that kind of the table, or of how it was a moment ago while it is being painted; NULL: none yet. What
 * changed is asked for. job's field does not count; its settings must stay the same, else all is made anew. Curvature is
 * times a texel's width: how much a slope turns from one texel to the next. Borrowed, valid until the next call. */
const WrField *wr_canvas_map_bring(WrCanvasMap *map, const WrField *field, WrFieldMapKind kind,
                                   const WrMapJob *job);
/* Is one under way? */
bool wr_canvas_map_busy(WrCanvasMap *map);
/* Tiles that were made so far, for tests. */
int64_t wr_canvas_map_tiles(const WrCanvasMap *map);
