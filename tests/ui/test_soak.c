/* Memory during hours of work: undo memory is bounded, and nothing else grows. Rounds of the same work through a
   session, with the window's previews and outlines; bytes are counted, so neither time nor the machine matters.
   WR_FULL=1 runs more rounds; WR_SOAK=BYTES prints the bytes of each, with that undo budget. */
#include "test.h"
#include "test_folder.h"
#include "command/session_help.h"

#include "base/memory.h"
#include "base/text.h"
#include "brush/brush.h"
#include "command/session.h"
#include "system/clock.h"

#include "ui/canvas/outline.h"
#include "ui/patch/preview/preview.h"
#include "ui/app/jobs/edit_preview.h"

#include <malloc.h>

#define BUDGET 3000000
#define SLACK 1e5 /* bytes: less than a tile in each of the counted rounds */

typedef struct Soak {
    WrSession *session;
    WrPreview *preview;
    WrEditPreview *trial;
    WrOutliner *outliner;
    TestRandom random;
    int events;
} Soak;

typedef struct Bytes {
    double undo, lines, document; /* bytes from the session's own counts */
    double used;                  /* all allocated blocks */
    double held;                  /* memory of malloc from the system, free or not */
    double resident;
} Bytes;

/* Without a timeout: it ends unless the machine is faulty. */
static void wait_for_preview(Soak *soak)
{
    while (!wr_preview_settled(soak->preview)) SDL_Delay(1);
    (void)wr_preview_picture(soak->preview);
    SDL_FlushEvents(SDL_USEREVENT, SDL_LASTEVENT);
}

static void look(Soak *soak, bool moving)
{
    const WrDocument *document = doc(soak->session);
    WrPreviewRequest wish = { .field = wr_document_field(document),
                              .scene = document->scene,
                              .width = 160,
                              .height = 120,
                              .moving = moving };
    wr_preview_want(soak->preview, &wish);
    wait_for_preview(soak);
}

static void stroke(Soak *soak)
{
    WrError err;
    char head[120];
    double u = test_random(&soak->random), v = test_random(&soak->random);
    snprintf(head, sizeof head, "stroke radius=%.1f strength=%.2f",
             4 + 30 * test_random(&soak->random), test_random(&soak->random));
    if (!wr_session_stroke_begin(soak->session, head, &err)) fail_msg("%s", err.text);
    for (int i = 0; i < 40; i++) {
        WrSample sample = { .u = u + 0.01 * i, .v = v, .pressure = 0.5, .seconds = 0.01 * i };
        if (!wr_session_stroke_add(soak->session, &sample, 1, &err)) fail_msg("%s", err.text);
        (void)wr_document_field(doc(soak->session)); /* the window shows it during the stroke */
    }
    if (!wr_session_stroke_end(soak->session, &err)) fail_msg("%s", err.text);
}

/* Tips from pictures, and presets of both engines: our own strokes, and libmypaint's. */
static void special_strokes(Soak *soak)
{
    static const char *const brushes[] = { "tip=" WR_SOURCE_DIR "/brushes/brick.png",
                                           "tip=" WR_SOURCE_DIR "/brushes/brick.png follow=on "
                                           "jitter=0.2,30,0.3",
                                           "preset=" WR_SOURCE_DIR "/brushes/bricks.myb",
                                           "preset=" WR_SOURCE_DIR "/brushes/bark.myb",
                                           "preset=" WR_SOURCE_DIR "/brushes/hammered.myb seed=4" };
    for (size_t i = 0; i < sizeof brushes / sizeof *brushes; i++) {
        WrText line = { 0 };
        wr_text_addf(&line, "stroke points=0.2,0.%d;0.7,0.5;0.4,0.8 radius=12 %s", (int)i + 1,
                     brushes[i]);
        must_run(soak->session, wr_text_get(&line));
        wr_text_fini(&line);
    }
    look(soak, false);
}

/* A dialog that previews an operation before it runs. */
static void try_blur(Soak *soak)
{
    WrEditPreviewRequest ask = { .op = wr_op_find("blur"), .param = { 2.0 } };
    wr_edit_preview_request(soak->trial, doc(soak->session), &ask);
    while (wr_edit_preview_busy(soak->trial, NULL, NULL)) SDL_Delay(1);
    (void)wr_edit_preview_field(soak->trial);
    wr_edit_preview_end(soak->trial);
    must_run(soak->session, "adjust blur sigma=2");
}

/* Work that ends in its initial state. */
static void work(Soak *soak)
{
    static const char *const lines[] = { "noise perlin cells=6 octaves=4 amplitude=0.3",
                                         "layer add a blend=max",
                                         "rotate 10,20,30",
                                         "camera perspective fov=30",
                                         "light directional to=1,1,1 index=1",
                                         "view back",
                                         "surface torus",
                                         "surface sphere",
                                         "select ellipse centre=0.5,0.5 radii=0.3,0.2",
                                         "layer mask 2 from=selection",
                                         "select none" };
    WrSession *s = soak->session;
    WrError err;
    must_run(s, "surface sphere");
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        must_run(s, lines[i]);
        stroke(soak);
        look(soak, i % 2);
    }
    special_strokes(soak);
    try_blur(soak);
    must_run(s, "undo 3");
    look(soak, false);
    must_run(s, "redo 2");
    assert_false(wr_session_run(s, "dab 0,0 radius=-1", &err));
    must_run(s, "layer flatten");
    must_run(s, "fill 0");
    must_run(s, "rotate pose=own");
    look(soak, false);
}

static double resident(void)
{
    long pages = 0, in_memory = 0;
    FILE *file = fopen("/proc/self/statm", "re");
    int got = file ? fscanf(file, "%ld %ld", &pages, &in_memory) : 0;
    if (file) fclose(file);
    return got == 2 ? (double)in_memory * (double)sysconf(_SC_PAGESIZE) : 0;
}

static Bytes count(const Soak *soak)
{
    const WrSession *s = soak->session;
    struct mallinfo2 heap = mallinfo2();
    Bytes b = { .undo = (double)wr_session_history_bytes(s),
                .used = (double)heap.uordblks + (double)heap.hblkhd,
                .held = (double)heap.arena + (double)heap.hblkhd,
                .resident = resident() };
    for (int i = 0; i < wr_session_history_count(s); i++)
        b.lines += (double)strlen(wr_session_history_line(s, i)) + 200; /* a step with its line */
    for (int i = 0; i < doc(s)->layer_count; i++)
        b.document += (double)wr_field_bytes(doc(s)->layers[i].heights);
    return b;
}

static void tell(int round, const Bytes *b)
{
    if (getenv("WR_SOAK"))
        printf("%4d  undo %8.0f  lines %8.0f  used %9.0f  held %9.0f  resident %9.0f\n", round,
               b->undo / 1e3, b->lines / 1e3, b->used / 1e3, b->held / 1e3, b->resident / 1e3);
}

static void nothing_but_the_text_of_the_steps_grows(void **state)
{
    (void)state;
    const char *all = getenv("WR_FULL");
    int rounds = all && *all == '1' ? 100 : test_amount(16, 6), settled = rounds / 2;
    Soak soak = { .session = wr_session_new(NULL),
                  .preview = wr_preview_new(2, "auto", SDL_USEREVENT),
                  .trial = wr_edit_preview_new(2, SDL_USEREVENT) };
    char line[64];
    double budget = getenv("WR_SOAK") ? atof(getenv("WR_SOAK")) : BUDGET;
    snprintf(line, sizeof line, "history budget=%.0f", budget);
    must_run(soak.session, "table 256x192");
    must_run(soak.session, line);
    Bytes half = { 0 }, end = { 0 };
    for (int round = 0; round < rounds; round++) {
        soak.random = (TestRandom){ 7 }; /* the same in each round */
        work(&soak);
        end = count(&soak);
        tell(round, &end);
        assert_true(end.undo <= budget);
        if (round == settled) half = end;
    }
    double grown = end.used - half.used - (end.lines - half.lines);
    if (half.used > 0 && budget <= BUDGET) /* not available with a sanitizer's malloc */
        assert_true(grown < SLACK);
    wr_edit_preview_free(soak.trial);
    wr_preview_free(soak.preview);
    wr_session_free(soak.session);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_but_the_text_of_the_steps_grows),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
