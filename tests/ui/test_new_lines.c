/* Lines for new documents from the dialog: every starter on every surface. */
#include "test.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/session.h"
#include "document/document.h"
#include "document/document_file.h"
#include "field/field.h"
#include "scene/scene.h"
#include "surface/surface.h"

#include "ui/app/state/line.h"

#include <string.h>

static void run(WrSession *session, const char *lines)
{
    for (const char *at = lines; *at;) {
        size_t length = strcspn(at, "\n");
        char *line = wr_strndup(at, length);
        WrError err = { "" };
        if (!wr_session_run(session, line, &err)) fail_msg("%s: %s", line, err.text);
        wr_free(line);
        at += length + 1;
    }
}

static bool is_level(const WrField *field)
{
    for (int j = 0; j < wr_field_height(field); j++)
        for (int i = 0; i < wr_field_width(field); i++)
            if (wr_field_get(field, i, j) != wr_field_get(field, 0, 0)) return false;
    return true;
}

static void every_starter_is_made_on_every_surface(void **state)
{
    (void)state;
    for (int n = 0; n < WR_STARTERS + WR_SURFACE_COUNT; n++) {
        WrNewForm form = { .width = 61 + n, .height = 47, .starter = n % WR_STARTERS };
        form.surface = n % WR_SURFACE_COUNT;
        if (!wr_new_surface(form.surface)) continue;
        WrSession *session = wr_session_new(NULL);
        WrText lines = { 0 };
        wr_new_document_lines(&form, wr_document_wrap_name(n % WR_DOCUMENT_WRAPS), &lines);
        run(session, wr_text_get(&lines));
        const WrDocument *document = wr_session_document(session);
        const WrField *field = document->layers[0].heights;
        assert_int_equal(wr_field_width(field), 61 + n);
        assert_int_equal(wr_field_height(field), 47);
        assert_int_equal(document->scene->shape.kind, form.surface);
        if (is_level(field) != (form.starter == 0)) fail_msg("%s", wr_text_get(&lines));
        wr_text_fini(&lines);
        wr_session_free(session);
    }
}

/* A cell keeps its shape: exactly on a plane; around a sphere and a tube as closely as whole repeats allow. */
static void cells_keep_their_shape(void **state)
{
    (void)state;
    static const int sizes[][2] = { { 512, 512 }, { 300, 200 }, { 128, 511 }, { 1000, 31 } };
    const WrSurfaceKind kinds[] = { WR_SURFACE_plane, WR_SURFACE_sphere, WR_SURFACE_cylinder,
                                    WR_SURFACE_torus };
    for (int n = 0; n < 16; n++) {
        const int *size = sizes[n / 4], kind = n % 4;
        WrNewForm form = { .width = size[0], .height = size[1], .surface = (int)kinds[kind] };
        WrSession *session = wr_session_new(NULL);
        WrText lines = { 0 };
        wr_new_document_lines(&form, wr_document_wrap_name(0), &lines);
        char *rest = strchr(wr_text_get(&lines), '\n') + 1; /* without its table */
        run(session, rest);
        const WrScene *scene = wr_session_document(session)->scene;
        const double cell = (double)size[0] / size[1], *p = scene->shape.value;
        const double wide = kind == 0   ? p[0] / p[1]
                            : kind == 1 ? 2.0
                            : kind == 2 ? 6.283185307179586 * p[0] / p[1]
                                        : p[0] / p[1]; /* the tube's middle over the tube */
        const double ru = scene->replicate_u, rv = scene->replicate_v;
        const double stretched = wide * rv / ru / cell; /* 1: as it is */
        if (kind == 0) assert_near(stretched, 1, 1e-12);
        else if (ru > 1) assert_true(stretched > 0.66 && stretched < 1.51);
        else assert_true(stretched < 1.51); /* a cell wider than the surface is compressed */
        wr_text_fini(&lines);
        wr_session_free(session);
    }
    double w, h;
    wr_new_sides(2, 1000, &w, &h);
    assert_near(w, 1000, 0);
    assert_near(h, 667, 0);
    wr_new_sides(4, 512, &w, &h);
    assert_true(w == 256 && h == 512);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_starter_is_made_on_every_surface),
        cmocka_unit_test(cells_keep_their_shape),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
