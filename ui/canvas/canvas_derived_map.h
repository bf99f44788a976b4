/* canvas_derived_map.h - map of the table (field/maps.h) for display on the canvas: computed in the background; after an edit
   only tiles within its reach are updated. Tested without a window. All calls are from the window's thread. */
#pragma once
#include "field/maps.h"

#include <SDL.h>
#include <stdbool.h>

typedef struct WrField WrField;

typedef struct WrCanvasMap WrCanvasMap;

/* threads: as in wr_pool_new. done_event: an SDL event type, pushed when tiles are ready. */
WrCanvasMap *wr_canvas_map_new(int threads, Uint32 done_event);
void wr_canvas_map_free(WrCanvasMap *map); /* NULL is allowed */

/* The newest map of that kind, which may lag behind the table during painting; NULL: none yet. Requests an update
 * after a change. job's field is ignored; a change of its settings restarts the map. Curvature is multiplied by the
 * texel width: change of slope from one texel to the next. Borrowed, valid until the next call. */
const WrField *wr_canvas_map_update(WrCanvasMap *map, const WrField *field, WrFieldMapKind kind,
                                    const WrMapJob *job);
/* True while an update is running. */
bool wr_canvas_map_busy(WrCanvasMap *map);
/* Number of tiles computed so far, for tests. */
int64_t wr_canvas_map_tiles(const WrCanvasMap *map);
