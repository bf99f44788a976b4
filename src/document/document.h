/* document.h - what a user works on: layers of heights and a scene. Plain data.
   Layer 5. Only a session (command/session.h) changes a document. */
#pragma once
#include "scene/scene.h"

typedef struct WrLayer {
    char *name;     /* UTF-8, owned */
    WrField *field; /* owned; shared tiles */
} WrLayer;

typedef struct WrComposite WrComposite; /* private to the room */

/* Commands edit layers[i].field in place and replace `scene`; layers have one size and one wrap. */
typedef struct WrDocument {
    WrLayer *layers; /* [layer_count], bottom first, owned; at least one, "base" */
    int layer_count;
    WrScene *scene;         /* shared; replaced, never written */
    WrComposite *composite; /* the sum of several layers, made when asked for */
} WrDocument;

/* An empty document: a 512 x 512 table at 0, periodic, one layer "base", the default scene. */
WrDocument *wr_document_new(void);
/* A snapshot: constant time, later edits of either do not show in the other. */
WrDocument *wr_document_share(const WrDocument *document);
void wr_document_free(WrDocument *document);

/* The composited F: the sum of the layers. With one layer it is that layer, in constant time; with
   several, tiles that changed since the last call are added up again. Borrowed until the next edit. Any
   number of threads may call it as long as nobody edits. */
const WrField *wr_document_field(const WrDocument *document);
/* Heights, layers and their names; the scene enters through scene_text, its canonical commands. */
WrHash wr_document_hash(const WrDocument *document, const char *scene_text);
