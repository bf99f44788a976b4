/* kept_mesh.h - which mesh a document has to keep. Layer 4. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrScene WrScene;
typedef struct WrTriangles WrTriangles;

/* The one mesh of the scene's objects, borrowed; NULL where none has one. Errors: several objects have different ones, of
 * which a document cannot keep all. */
bool wr_scene_kept_mesh(const WrScene *scene, const WrTriangles **out, WrError *err);
