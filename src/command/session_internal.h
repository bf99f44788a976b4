/* session_internal.h - the inside of a session, for the commands' functions only.
   Layer 6, private to src/command. */
#pragma once
#include "base/array.h"
#include "base/file_identity.h"
#include "brush/brush.h"
#include "command/command_line.h"
#include "command/session.h"
#include "document/document.h"
#include "document/document_file.h"
#include "document/history.h"
#include "document/journal.h"
#include "document/object_tables.h"
#include "document/view_history.h"
#include "image/image.h"
#include "scene/scene.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrBrushFiles WrBrushFiles;

/* A brush and what it borrows from. */
typedef struct WrHeldBrush {
    WrBrush brush;
    WrPreset *preset; /* owned; NULL: none */
    WrTip *tip;       /* owned; NULL: none, or the preset's */
} WrHeldBrush;

/* Paint under way on the active layer. Zeroed: none. */
typedef struct WrPainting {
    WrHeldBrush held;
    WrBrushGround ground; /* borrows from the document and from below */
    WrField *below;       /* owned; NULL: not needed */
    WrField
        *cover_before; /* erasing must clear heights where the cover goes to 0: the cover as it was;
                              owned; NULL: it must not */
} WrPainting;

/* What is replaced as a whole by open and reset, and put back where open fails. */
typedef struct WrSessionState {
    WrDocument *document; /* owned; between commands, what the history's present state holds */
    WrHistory *history;   /* owned; its marks are revisions */
    WrViews *views;       /* owned; the present one is the document's */
    uint64_t saved_revision;
    char *path;        /* of the document file; owned; NULL: none */
    WrFileStamp stamp; /* of that file as it was opened or saved here */
    char *origin;     /* the command line that makes the history's first state; owned; NULL: none */
    char *newer_path; /* a file of a newer version that must not be saved over; owned; NULL: none */
    char *chosen; /* the dials that the document keeps for its tolerance (wr_choice_write); owned;
                         NULL: none */
    bool chosen_told; /* that they are of no use was said */
} WrSessionState;

struct WrSession {
    WrSessionOptions options; /* isa is a copy, owned */
    WrSessionState state;
    uint64_t last_revision; /* that was ever given */
    size_t budget;          /* of the history, bytes */
    const WrDocument *made; /* while a line runs whose work is done already; borrowed */
    int depth;         /* commands under way, one inside the other; only the outermost is a step */
    char *folder;      /* of the script that is running; borrowed; NULL: the current folder */
    bool skip_outputs; /* while a script is opened rather than run */
    bool loading;      /* the scene's lines of a document are running */
    bool opening;      /* a script, a picture or a recovery is being opened: nothing is journaled */
    WrJournal *journal; /* of the document, from its first command on; owned; NULL: none yet */
    int journal_base, journal_top;            /* history positions that a replay of it can reach */
    int64_t view_base, view_top;              /* and numbers of views */
    WrImage *(*embedded)[WR_OBJECT_PICTURES]; /* while loading: the document's pictures by their
                                                 objects; borrowed; NULL: none */
    WrImage *embedded_mesh;                   /* the same of its mesh */
    WrRenderer *renderer;                     /* made on first use; owned */
    WrTables *tables;                         /* of the objects of its last picture; owned */
    WrTableCache table_cache;
    WrChoice choice; /* of the last picture under a tolerance */

    WrStroke *stroke;    /* open stroke, or NULL; owned */
    WrCall *stroke_call; /* its line so far; owned */
    WrPainting painting; /* what it paints with and on */
    WrStandIn stand_in;  /* for the mask that a command, or the open stroke, changes */

    WrBrushFiles *brush_files; /* presets and tips that were read; made on first use; owned */
    WR_ARRAY(char *) kept;     /* SHA-256 of the files that the journal has copies of; owned */
    WR_ARRAY(WrSessionInput) inputs; /* their paths are owned */

    bool still;         /* it is one: wr_session_snapshot */
    bool unsafe;        /* of a still: its journal is not */
    char *unsafe_words; /* why; owned */
};

/* Say something that is no failure. */
void wr_session_note(WrSession *session, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/* `path` as a command of the running script means it for reading. Caller frees. */
char *wr_session_input_path(WrSession *session, const char *path);
/* That file is about to be read, or was: one of wr_session_input. */
void wr_session_note_input(WrSession *session, const char *path);
void wr_session_forget_inputs(WrSession *session);
/* "a stroke is being drawn"; a still refuses all. */
bool wr_session_refuse_in_stroke(const WrSession *session, WrError *err);

/* ---- steps ---- */

/* The document's hash with another scene in the place of its own. */
WrHash wr_session_hash_with(const WrSession *session, const WrScene *scene);
/* The command of that call is done: make it a step. */
void wr_session_remember(WrSession *session, const WrCall *call);
/* Go to a state of the history; only undo and redo do so, that the journal may know. */
bool wr_session_go_to(WrSession *session, int state, WrError *err);
/* Bring the document back to what the history's present state holds. */
void wr_session_restore(WrSession *session);
/* Begin the history anew from the document as it is, with a new revision. */
void wr_session_rebase(WrSession *session);
/* Put a new document (taken) in place of the old state, which is returned: then keep the new one as
   opened, or put the old one back. Either consumes *old. */
/* An empty document, as options.smooth has it. */
WrDocument *wr_session_new_document(const WrSession *session);
WrSessionState wr_session_begin_state(WrSession *session, WrDocument *document);
void wr_session_keep_state(WrSession *session, WrSessionState *old);
void wr_session_restore_state(WrSession *session, WrSessionState *old);

/* ---- chosen dials: session_chosen.c ---- */

/* Where nothing is chosen for that picture yet: take the dials that the document keeps, if they are for it; a note says
   so once if they are not. */
void wr_session_recall_chosen(WrSession *session, const WrFrameRequest *request);
/* The scene's canonical lines as files keep them: with the dials that were chosen for its tolerance. */
void wr_session_kept_text(WrSession *session, WrText *text);

/* ---- views: session_views.c ---- */

/* The document may be looked at in another way now: then that is a view. */
void wr_session_note_view(WrSession *session);
/* The lines that lead from where the session's history began to the document as it is: the steps in force,
   and the views where they are needed, oldest first. folder: as wr_history_folder. */
typedef void WrLineSink(void *ctx, const char *line, const char *folder);
void wr_session_lines(const WrSession *session, WrLineSink *sink, void *ctx);
/* The scene as it was when the history began, in all that views change. The caller owns it. */
WrScene *wr_session_scene_at_start(const WrSession *session);

/* ---- the journal: session_journal.c ---- */

/* Around an outermost command that changes the document. Views alone begin no journal: nothing would be
   lost but how it is looked at. */
void wr_session_journal_before(WrSession *session, const WrCall *call);
/* pushed: it made a step, rather than going through them. */
void wr_session_journal_after(WrSession *session, bool good, bool pushed);
/* A stroke; rows as printed, with their lengths. kept: false if it was cancelled or empty. */
void wr_session_journal_stroke_begin(WrSession *session, const WrCall *call);
void wr_session_journal_stroke_add(WrSession *session, const double rows[][6], const int *lengths,
                                   int count);
void wr_session_journal_stroke_end(WrSession *session, bool kept);
/* The document was saved as its path: the journal notes that and goes on, so that a recovery knows the name,
   and has the lines still should the file not be there then. */
void wr_session_journal_saved(WrSession *session);
/* The document is given up, or the session ends: its journal goes. */
void wr_session_journal_drop(WrSession *session);
/* Begin a journal from a snapshot of the document as it is, which was read back. */
bool wr_session_journal_anew(WrSession *session, WrError *err);
/* Does the file hold what the session's document is? */
bool wr_session_reads_back(WrSession *session, const char *path, WrError *err);

/* ---- what commands change ---- */

/* The triangles of `surface terrain file=`, and what is told of them; what its layer= does. */
WrTriangles *wr_terrain_read(WrSession *session, const char *path, const WrShape *shape,
                             WrError *err);
void wr_terrain_note(WrSession *session, const char *path, const WrTriangles *mesh);
bool wr_terrain_names_layer(const WrCall *call);
bool wr_terrain_take_layer(WrSession *session, WrCall *call, WrScene *scene, WrError *err);
/* Is an object's colouring another by now? And its picture, made anew. */
bool wr_height_colormap_lags(const WrSession *session, const WrScene *object);
bool wr_height_colormap_make(const WrSession *session, WrScene *object, WrError *err);
/* Terrains take the form of their layers, where those have changed, and colours by height follow. Called when a command, or a stroke, is done. */
bool wr_session_follow(WrSession *session, WrError *err);
/* The layer that edits change, or what stands in for its mask. NULL and an error if it is locked or not shown. */
WrLayer *wr_session_layer(WrSession *session, WrError *err);
bool wr_session_check_layer(const WrSession *session, WrError *err); /* only whether */
/* Fails if that layer is a filter, which has none, unless edits go to its mask. */
bool wr_session_check_heights(const WrSession *session, int index, WrError *err);
/* "layer 2 \"moss\"": how messages name a layer. */
const char *wr_session_layer_name(const WrSession *session, int index, WrText *buffer);
/* Fails if that layer is locked. */
bool wr_session_check_unlocked(const WrSession *session, int index, WrError *err);
/* Put `made` (taken) in the place of *field, of the same size, inside the selection. */
void wr_session_put_field(WrSession *session, WrField **field, WrField *made);
/* Give a layer new heights of the same size (taken), inside the selection; there it now says something. */
void wr_session_put_heights(WrSession *session, WrLayer *layer, WrField *heights);
/* Put a changed clone in the document's place for its scene; takes it. */
void wr_session_replace_scene(WrSession *session, WrScene *scene);
/* The index of the layer that a command's argument names: by number, from 1, or by name. */
bool wr_session_find_layer(const WrSession *session, const char *word, int *index, WrError *err);

/* The SHA-256 of what a command reads from a file: of a glTF with parts beside it that of the packed one (gltf.h), which
   changes with any of them. */
bool wr_input_sha256(const char *path, char hex[65], WrError *err);
/* Read a picture's file, or one that a glTF file holds or names, "FILE.glb#2". The caller frees it. */
WrImage *wr_input_image(const char *path, const WrImageWish *wish, WrError *err);
/* Hash a file that a command reads, compare with what the line says, and write it into the line. */
bool wr_session_check_sha256(WrCall *call, const char *path, WrError *err);
/* The same for a file that was hashed already; name: of the argument that holds the hash. */
bool wr_call_check_sha256(WrCall *call, const char *name, const char *path, const char *hex,
                          WrError *err);
/* Read the picture that a line names; checks its sha256= argument, or sets it. The caller owns it. */
WrImage *wr_session_read_image(WrSession *session, WrCall *call, const char *name, WrError *err);
/* Its channel= and part= arguments. */
WrImageWish wr_call_wish(WrCall *call);
/* Tell what was taken of a picture's file that has more, and how many values were not finite. */
void wr_session_note_read(WrSession *session, const char *path, const WrImage *image);
/* The heights of a picture in a table like `like`, by what its label says of it (labels false: whatever it says). */
WrField *wr_session_heights_of(WrSession *session, WrImageRows *rows, const char *path, bool labels,
                               const WrField *like, WrError *err);
/* What `object set table=` says: the file becomes a layer, hidden, that the scene's object at hand wears. */
bool wr_object_take_table(WrSession *session, WrCall *call, WrScene *scene, WrError *err);
/* Put a document file's content in the place of the session's document, scene included. */
bool wr_session_load(WrSession *session, const char *path, WrError *err);

/* ---- paint: session_paint.c ---- */

/* The brush that a line describes, and the active layer as its ground. Fills in the hashes of the files that
 * the line names, or compares. False and an error, and nothing to end, if the layer is locked or not shown,
 * or the brush cannot be had. */
bool wr_painting_begin(WrSession *session, WrCall *call, WrPainting *painting, WrError *err);
/* The paint is on: finish what erasing leaves, and let go. After a failure too; fine on a zeroed one. */
void wr_painting_end(WrSession *session, WrPainting *painting);
/* Draw a whole stroke of samples, sample(ctx, 0) .. sample(ctx, count - 1). False and an error when
 * cancelled. */
typedef WrSample WrSampleAt(const void *ctx, int index);
bool wr_session_draw(const WrPainting *painting, WrSampleAt *sample, const void *ctx, int count,
                     WrError *err);
/* One of the brush's arguments is given. False where the form has none of that name. */
bool wr_call_gives(const WrCall *call, const char *name);

/* ---- presets and tips: session_brushes.c ---- */

/* A file that brushes come from. Borrowed until the next call. */
typedef struct WrBrushFile {
    const char *path; /* absolute */
    const char *sha256;
    const WrPreset *preset; /* or: */
    const WrTip *tip;
    const char *tip_path; /* of the preset's own tip, beside it; NULL: none */
} WrBrushFile;
/* Read it, or find it among those read before, unless the file has changed since. word: as in a line of the
 * script whose folder that is (NULL: the current one). */
bool wr_session_preset_file(WrSession *session, const char *word, const char *folder,
                            WrBrushFile *file, WrError *err);
bool wr_session_tip_file(WrSession *session, const char *word, const char *folder,
                         WrBrushFile *file, WrError *err);
void wr_brush_files_free(WrBrushFiles *files); /* NULL is fine */

/* The check of set=. */
bool wr_check_settings(const void *ctx, const char *name, const char *value, WrError *err);

/* Handlers that others call too; the rest are their files' own. */
typedef bool WrHandler(WrSession *session, WrCall *call, WrError *err);
WrHandler wr_run_generate;                       /* generate_commands.c */
WrHandler wr_run_adjust;                         /* adjust_command.c */
WrHandler wr_run_filter;                         /* filter_command.c */
WrHandler wr_run_undo, wr_run_redo, wr_run_view; /* history_commands.c */

/* The scene's canonical lines: each command's row prints its own. */
typedef void WrScenePrinter(const WrScene *scene, WrText *text);
WrScenePrinter wr_print_rotate, wr_print_camera;
/* A `rotate` as the edit that turns one of several objects; false where it says neither or both. */
bool wr_rotate_as_edit(const WrCall *call, WrText *text);
/* named: with the file's name; else by its content alone. */
void wr_print_colour(const WrScene *scene, bool named, WrText *text);
void wr_print_normals(const WrScene *scene, bool named, WrText *text);
void wr_print_facets(const WrScene *scene, int kind, bool named, WrText *text); /* WrFacetKind */
void wr_print_environment(const WrScene *scene, bool named, WrText *text);
void wr_print_object(const WrScene *scene, int i,
                     WrText *text);                       /* of several: adds it, with its place */
void wr_print_chosen(const WrScene *scene, WrText *text); /* where that is not the last one */
/* All of them; of several objects each one's own lines, then those that all share. after: is called after each command's
   lines, or NULL. */
typedef void WrScenePart(void *ctx, const WrCommand *command, WrText *text);
void wr_print_scene(const WrScene *scene, WrScenePart *after, void *ctx, WrText *text);
/* The same; a picture as what its content is, wherever its file lies. */
void wr_print_identity(const WrScene *scene, WrText *text);

/* Words of choices, index past the last gives NULL. */

/* ---- scene_text.c: parts of lines ---- */
