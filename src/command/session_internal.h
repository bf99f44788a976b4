/* session_internal.h - private state and helpers of a session, for the command handlers. Private to src/command. */
#pragma once
#include "base/array.h"
#include "base/file.h"
#include "brush/brush.h"
#include "command/command_line.h"
#include "command/layer_plan.h"
#include "command/made_from.h"
#include "command/linked_copies.h"
#include "command/session.h"
#include "document/document.h"
#include "document/document_file.h"
#include "document/history.h"
#include "document/recovery_journal.h"
#include "document/object_tables.h"
#include "image/image.h"
#include "scene/scene.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrExportReport WrExportReport;

typedef struct WrBrushFiles WrBrushFiles;
typedef struct WrMeshTexels WrMeshTexels;
typedef struct WrTriangles WrTriangles;

/* A brush and the files it borrows from. */
typedef struct WrHeldBrush {
    WrBrush brush;
    WrPreset *preset; /* owned; NULL: none */
    WrTip *tip;       /* owned; NULL: none, or the preset's */
} WrHeldBrush;

/* Painting in progress on the active layer. Zeroed: none. */
typedef struct WrPainting {
    WrHeldBrush held;
    WrBrushGround ground; /* borrows from the document and from `below` */
    WrField *below;       /* owned; NULL: not needed */
    /* coverage before the stroke, if erasing must clear the heights where coverage reaches 0;
       owned; NULL: it must not */
    WrField *cover_before;
} WrPainting;

/* The part of a session that open and reset replace as a whole, and that a failed open restores. */
typedef struct WrSessionState {
    WrDocument *document; /* owned; between commands, the history's present state */
    WrHistory *history;   /* owned; its state numbers are revisions */
    WrViews *views;       /* owned; the present view is the document's */
    uint64_t saved_revision;
    char *path;           /* path of the document file; owned; NULL: none */
    WrFileIdentity stamp; /* identity of that file when it was opened or saved here */
    char *origin; /* command line that creates the history's first state; owned; NULL: none */
    WrFileIdentity origin_file; /* the document file that it opens, before that was read */
    char origin_sha256[65];     /* of its content */
    char *newer_path; /* file of a newer version that must not be overwritten; owned; NULL: none */
    /* stored dials of the document for its tolerance (wr_choice_write); owned; NULL: none */
    char *chosen;
    bool misfit_reported; /* the note that they do not fit was sent */
} WrSessionState;

struct WrSession {
    WrSessionOptions options; /* isa is a copy, owned */
    WrSessionState state;
    uint64_t last_revision; /* highest revision used so far */
    size_t budget;          /* of the history, in bytes */
    WrLayer group; /* the last group that was copied, as a layer: heights and coverage; owned */
    uint64_t group_key;     /* of its members; 0: none */
    const WrDocument *made; /* result of the running line if already computed; borrowed */
    int depth;              /* nesting depth of running commands; only the outermost is a step */
    char *folder;           /* folder of the running script; borrowed; NULL: the current folder */
    bool skip_outputs;      /* a script is opened rather than run */
    bool loading;           /* the scene lines of a document are running */
    bool nameless;          /* errors do not begin with the command's name */
    bool opening; /* a script, a picture or a recovery is being opened: nothing is journaled */
    WrJournal *journal; /* of the document, from its first command; owned; NULL: none yet */
    /* history positions that a replay of the journal can reach */
    int journal_base, journal_top;
    int64_t view_base, view_top; /* numbers of views that a replay can reach */
    /* while loading: embedded pictures of the document, by object; borrowed; NULL: none */
    WrImage *(*embedded)[WR_OBJECT_PICTURES];
    WrImage *embedded_mesh; /* while loading: embedded picture of the mesh */
    WrRenderer *renderer;   /* created on first use; owned */
    /* prepared tables of the objects of the last picture; owned */
    WrTables *tables;
    WrTableCache table_cache;
    WrChoice choice; /* dials of the last picture under a tolerance */

    WrStroke *stroke;          /* open stroke, or NULL; owned */
    WrCall *stroke_call;       /* the stroke's line so far; owned */
    WrPainting painting;       /* brush and target of the stroke */
    WrMeshTexels *mesh_texels; /* of the mesh last painted on; owned; NULL: none yet */
    bool mesh_sharing_told;    /* the note about its shared texels was sent */
    WrStandIn stand_in;        /* replaces the mask that a command, or the open stroke, changes */

    WrBrushFiles *brush_files;       /* cached presets and tips; created on first use; owned */
    WR_ARRAY(char *) kept;           /* SHA-256 of the files copied into the journal; owned */
    WR_ARRAY(WrSessionInput) inputs; /* files read by lines; paths are owned */

    /* tables from which live masks and layers with a line were made, to make them again where these change only */
    WrMadeFrom *made_from;
    bool still;           /* this is a snapshot: wr_session_snapshot */
    double step_seconds;  /* running time of the step so far */
    uint64_t made_before; /* number of the last making (layer_times.h) before the last command */
    bool unsafe;          /* of a snapshot: the journal is not safe */
    char *unsafe_words;   /* the cause; owned */
};

/* Send a note to options.note; not an error. */
void wr_session_note(WrSession *session, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/* Replace <UDIM> in the names of files that a call reads by the number of the object's tile, or if it has none by the
   lowest with a file; note the other tiles of a file that is one of several. */
bool wr_session_take_tiles(WrSession *session, WrCall *call, WrError *err);
/* Resolve a path for reading, relative to the folder of the running script. The caller frees it. */
char *wr_session_input_path(WrSession *session, const char *path);
/* Record a file that is about to be read, or was read, for wr_session_input. */
/* Passes the receipt of a written file to options.receipt. report: NULL: none; began: wr_clock_seconds then. */
void wr_session_receipt(WrSession *session, const char *file, const char *kind,
                        const WrExportReport *report, double began);
void wr_session_note_input(WrSession *session, const char *path);
/* Error "a stroke is being drawn"; a snapshot refuses all commands. */
bool wr_session_refuse_in_stroke(const WrSession *session, WrError *err);

/* ---- steps ---- */

/* The document's hash with its scene replaced by `scene`. */
WrHash wr_session_hash_with(const WrSession *session, const WrScene *scene);
/* Record the finished command of that call as a step. */
void wr_session_remember(WrSession *session, const WrCall *call);
/* Make the composite after the outermost command, if options.composites is set. */
bool wr_session_make_composite(WrSession *session, WrError *err);
/* Go to a state of the history. Only commands call this, so that the journal records it. */
bool wr_session_go_to(WrSession *session, int state, WrError *err);
/* Goes `steps` back (negative) or forward, over revisions too. False: not so many. */
bool wr_session_travel(WrSession *session, int steps);
/* The next line of the journal cannot be replayed on its lines: the journal starts again after this command. */
void wr_session_journal_cut(WrSession *session);
/* Restore the document to the history's present state. */
void wr_session_restore(WrSession *session);
/* Replace the session's document by another one (ownership passes); its cached composite is reused. */
void wr_session_put_document(WrSession *session, WrDocument *document);
/* Restart the history at the current document, with a new revision. */
void wr_session_restart_history(WrSession *session);
/* Replace the state by a new document (ownership passes to the session); returns the old state. Afterwards either
   keep the new one as opened, or restore the old one. Either consumes *old. */
/* An empty document with the samples per pixel of options.smooth. */
WrDocument *wr_session_new_document(const WrSession *session);
WrSessionState wr_session_begin_state(WrSession *session, WrDocument *document);
void wr_session_keep_state(WrSession *session, WrSessionState *old);
void wr_session_restore_state(WrSession *session, WrSessionState *old);

/* ---- stored dials: session_picture.c ---- */

/* The scene's canonical lines for a file, including the dials chosen for its tolerance. */
void wr_session_kept_text(WrSession *session, WrText *text);

/* ---- views: session.c ---- */

/* The lines that lead from the start of the session's history to the current document: the steps in force, and views
   where needed, oldest first. folder: as in wr_history_folder. */
typedef void WrLineSink(void *ctx, const char *line, const char *folder);
void wr_session_lines(const WrSession *session, WrLineSink *sink, void *ctx);
/* The scene with all view settings as at the start of the history. The caller owns it. */
WrScene *wr_session_scene_at_start(const WrSession *session);

/* ---- the journal: session_file.c ---- */

/* Called around an outermost command that changes the document. Views alone do not start a journal, since only the
   view would be lost. */
void wr_session_journal_before(WrSession *session, const WrCall *call);
/* pushed: the command made a step, rather than moving through the history. */
void wr_session_journal_after(WrSession *session, const WrCall *call, bool good, bool pushed);
/* Journal a stroke; a sample's numbers as printed. kept: false if it was cancelled or empty. */
void wr_session_journal_stroke_begin(WrSession *session, const WrCall *call);
void wr_session_journal_stroke_add(WrSession *session, const double *row, int length);
void wr_session_journal_stroke_end(WrSession *session, bool kept);
/* Record in the journal that the document was saved to its path. A recovery then has the file name, and still has the
   lines if the file is gone. */
void wr_session_journal_saved(WrSession *session);
/* Remove the journal: the document is discarded, or the session ends. */
void wr_session_journal_drop(WrSession *session);
/* Restart the journal from a snapshot of the current document; the snapshot is read back. */
bool wr_session_journal_anew(WrSession *session, WrError *err);
/* True if the file's content equals the session's document. */
bool wr_session_reads_back(WrSession *session, const char *path, WrError *err);

/* ---- changes by commands ---- */

/* True if the height colormap of an object is out of date; and its newly computed picture. */
bool wr_height_colormap_lags(const WrSession *session, const WrScene *object);
bool wr_height_colormap_make(const WrSession *session, WrScene *object, WrError *err);
/* Update terrains whose layers have changed, and colours by height. Called at the end of a command or a stroke. */
bool wr_session_follow(WrSession *session, WrError *err);

/* ---- layers that depend on others: follow_layers.c ---- */

/* Identity of the layers below a layer, one number instead of their composite: of those that are shown (in a document with groups
   of all), and of all with their names. */
typedef struct WrBelowKey {
    WrHash shown, all;
} WrBelowKey;
void wr_session_below_key(const WrDocument *document, int index, WrBelowKey *key);
/* Identity of a group's composite: of its members and its blend. */
WrHash wr_session_group_key(const WrDocument *document, int group);

/* For each layer whether the picture needs it, and if not, why. */
void wr_session_layer_needs(const WrSession *session, WrLayerNeed needs[WR_LAYERS_MAX]);
/* At the end of every command, from the bottom up: make the generator layers and live masks that the picture needs and that
   read layers that have changed; layers whose heights another command wrote become plain. */
bool wr_session_follow_layers(WrSession *session, WrError *err);
/* The same with those that the picture does not need, before a command that uses them all. */
bool wr_session_make_all_layers(WrSession *session, WrError *err);

/* ---- generator layers: generator_layers.c ---- */

/* Insert `layer` (new, empty; ownership passes) at *index and generate it by the from= of `outer`; the selection becomes its
   mask, or of an edge of the selection a layer of opacity 0 below it, and *index is 1 more. blend= and radius= of that line become
   the layer's. */
bool wr_session_add_generator_layer(WrSession *session, WrCall *outer, int *index, WrLayer layer,
                                    WrError *err);
/* Layer `index` is about to get another name: the lines above that name it get it too. */
void wr_session_rename_in_lines(WrSession *session, int index, const char *name);
/* Generate a generator layer by the from= of `outer` if given, or else by its own line, with the words of `change` (may be
   NULL) in place of the line's. */
bool wr_session_change_generator_layer(WrSession *session, WrCall *outer, int index,
                                       const char *change, WrError *err);
/* If a call is `layer set N change=` of a line that names a file, give it that line as from= instead: journals and scripts
   then hold the file's absolute name and checksum. */
void wr_session_spell_change(WrSession *session, WrCall *call);
/* Generate a layer by its own line, after a change that its content depends on. */
bool wr_session_generate_again(WrSession *session, int index, WrError *err);
/* Give a generator layer another line, and generate it. An unknown line is left out, with a
   note. */
bool wr_session_use_line(WrSession *session, int index, const char *line, WrError *err);
/* Generate a layer again if it is needed and its line reads layers that have changed, or if it is a linked copy that is read;
   if another command wrote its heights, make it plain. */
bool wr_session_follow_line(WrSession *session, const WrLinks *links, int index, bool needed,
                            bool read, WrError *err);
/* Index of the layer below that the line of layer `index` names; -1: none. */
int wr_session_line_layer(const WrSession *session, int index);
/* Note the layers whose files are missing, each file once, and those whose lines, or terms of masks, this program does not know. */
void wr_session_note_lines(WrSession *session);

/* ---- live masks: live_masks.c ---- */

/* Make the layer's mask a live one, by these terms, or a plain one by "off". */
bool wr_session_set_live_mask(WrSession *session, int index, const char *line, WrError *err);
/* Make the live mask of a layer again, if anything that it reads has changed. */
bool wr_session_follow_mask(WrSession *session, int index, WrError *err);
/* Note a live mask whose terms this program does not know. */
void wr_session_note_mask(WrSession *session, int index);
/* The terms of a mask of layer `of` with another name for layer `index`; NULL: they do not read it. The caller frees it.
   Before the layer is renamed. */
char *wr_mask_line_renamed(const WrDocument *document, int of, const char *line, int index,
                           const char *name);
/* Layer `index` is about to get another name: the terms of the masks above that read it get it too. */
void wr_session_rename_in_masks(WrSession *session, int index, const char *name);

/* ---- variants: variant_commands.c ---- */

/* Layer `index` is about to get another name: lines and terms in variants that read it get it too. */
/* A layer that was joined of others: its present values are those of all variants. */
void wr_session_store_in_variants(WrSession *session, int index);
void wr_session_rename_in_variants(WrSession *session, int index, const char *name);

/* ---- the active layer ---- */

/* The layer that edits change, or the stand-in for its mask. NULL and an error if it is locked or hidden. */
WrLayer *wr_session_layer(WrSession *session, WrError *err);
/* Name of a layer in messages: "layer 2 \"moss\"". */
const char *wr_session_layer_name(const WrSession *session, int index, WrText *buffer);
/* Replace *field by `made` (ownership passes; same size) inside the selection. */
void wr_session_put_field(WrSession *session, WrField **field, WrField *made);
/* Replace a layer's heights inside the selection (ownership passes; same size); the layer's coverage there becomes
   1. */
void wr_session_put_heights(WrSession *session, WrLayer *layer, WrField *heights);
/* Replace the document's scene by a changed clone; ownership passes to the session. */
void wr_session_replace_scene(WrSession *session, WrScene *scene);
/* Index of the layer that a command's argument names: by number, from 1, or by name. */
bool wr_session_find_layer(const WrSession *session, const char *word, int *index, WrError *err);
/* Layers of an argument that may list several, separated by commas; each once, the lowest first. */
typedef struct WrLayerList {
    int index[WR_LAYERS_MAX];
    int count;
} WrLayerList;
bool wr_layers_find(const WrDocument *document, const char *words, WrLayerList *layers,
                    WrError *err);

/* SHA-256 of a file that a command reads. For a glTF with external parts, that of the packed file (gltf.h), which
   changes with any part. */
bool wr_input_sha256(const char *path, char hex[65], WrError *err);
/* Read a picture file, or a picture that a glTF file contains or references, "FILE.glb#2". The caller frees it. */
WrImage *wr_input_image(const char *path, const WrImageRequest *wish, WrError *err);
/* Hash a file that a command reads, compare with the line's checksum, and store it in the line. */
bool wr_session_check_sha256(WrCall *call, const char *path, WrError *err);
/* Check the checksum of a file that was hashed already; name: the argument that holds it. */
bool wr_call_check_sha256(WrCall *call, const char *name, const char *path, const char *hex,
                          WrError *err);
/* Read a mesh file, with notes of points that were moved to the origin, and of bad (u,v). about: the place of the file that
   becomes the origin; NULL: its own, or one near a mesh that is far from it. */
typedef struct WrMeshFacts {
    WrLengthUnit unit; /* that the file states */
    double origin[3];  /* that was subtracted from its points; 0,0,0: none */
} WrMeshFacts;
WrTriangles *wr_session_read_mesh(WrSession *session, const char *path, const double *about,
                                  WrMeshFacts *facts, WrError *err);
/* The channel= and part= arguments of a call. */
WrImageRequest wr_call_request(WrCall *call);
/* Note which part of a picture file was read if it has several, and the number of values that were not finite. */
void wr_session_note_read(WrSession *session, const char *path, const WrImage *image);
/* Convert a picture to heights in a table like `like`, using its labels (labels false: ignore them). */
WrField *wr_session_heights_of(WrSession *session, WrImageRows *rows, const char *path, bool labels,
                               const WrField *like, WrError *err);
/* Replace the session's document by the content of a document file, scene included. */
bool wr_session_load(WrSession *session, const char *path, WrError *err);

/* ---- painting: session_paint.c ---- */

/* Create the brush that a line describes, with the active layer as its target. Sets or checks the checksums of the
 * files that the line names. False and an error, with nothing to end, if the layer is locked or hidden, or the brush
 * cannot be loaded. */
bool wr_painting_begin(WrSession *session, WrCall *call, WrPainting *painting, WrError *err);
/* Finish painting: clear heights where erasing removed all coverage, and free the brush. Required after a failure
   too; a zeroed painting is allowed. */
void wr_painting_end(WrSession *session, WrPainting *painting);
/* Draw a whole stroke of samples, sample(ctx, 0) .. sample(ctx, count - 1). False and an error when cancelled. */
typedef WrSample WrSampleAt(const void *ctx, int index);
bool wr_session_draw(const WrPainting *painting, WrSampleAt *sample, const void *ctx, int count,
                     WrError *err);
/* True if the line contains that brush argument. False if the form has none of that name. */
bool wr_call_gives(const WrCall *call, const char *name);

/* ---- presets and tips: session_paint.c ---- */

/* A file that brushes are loaded from. Borrowed until the next call. */
typedef struct WrBrushFile {
    const char *path; /* absolute */
    const char *sha256;
    const WrPreset *preset; /* or NULL if the file is a tip: */
    const WrTip *tip;
    const char *tip_path; /* tip file of the preset, in its folder; NULL: none */
} WrBrushFile;
/* The cached file, read again if it has changed. word: from a line of the script in `folder` (NULL: the current one).
 */
bool wr_session_load_preset(WrSession *session, const char *word, const char *folder,
                            WrBrushFile *file, WrError *err);
bool wr_session_tip_file(WrSession *session, const char *word, const char *folder,
                         WrBrushFile *file, WrError *err);
void wr_brush_files_free(WrBrushFiles *files); /* NULL is allowed */

/* Print the scene's canonical lines: each command's row prints its own. */
typedef void WrScenePrinter(const WrScene *scene, WrText *text);
WrScenePrinter wr_print_rotate, wr_print_camera;
/* with several objects: adds the object, with its position */
void wr_print_object(const WrScene *scene, int i, WrText *text);
/* chosen object, if it is not the last one */
void wr_print_chosen(const WrScene *scene, WrText *text);
/* Print all scene lines: with several objects the lines of each object, then the shared ones. after: called after
   each command's lines, or NULL. */
typedef void WrScenePart(void *ctx, const WrCommand *command, WrText *text);
void wr_print_scene(const WrScene *scene, WrScenePart *after, void *ctx, WrText *text);
/* Print all scene lines with checksums instead of file paths. */
void wr_print_identity(const WrScene *scene, WrText *text);
