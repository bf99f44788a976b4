/* The list of installed fonts: included and excluded files; a font that crashes fontconfig does not affect the
   others. */
#include "test.h"

#include "test_folder.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "image/font_list.h"

#include <fontconfig/fontconfig.h>

#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

#define SANS "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"
#define BOLD "/usr/share/fonts/truetype/dejavu/DejaVuSerif-Bold.ttf"
#define INDIAN "/usr/share/fonts/truetype/lohit-devanagari/Lohit-Devanagari.ttf"

/* Replaces fontconfig: crashes on request, as a hostile font could cause it. */
static bool deadly;
static pid_t self;

FcBool FcInit(void)
{
    if (deadly) raise(SIGSEGV);
    FcConfig *config = FcInitLoadConfigAndFonts();
    return config && FcConfigSetCurrent(config);
}

static void copy_damaged(const char *from, const char *to, int every)
{
    char *bytes = NULL;
    size_t length;
    WrError err = { "" };
    if (!wr_file_read(from, 1 << 24, &bytes, &length, &err)) fail_msg("%s", err.text);
    for (size_t i = 0; every > 0 && i < length; i += (size_t)every) bytes[i] ^= 0x5a;
    if (every < 0) length /= 3;
    /* other programs may write names with line breaks; this one refuses */
    FILE *file = fopen(to, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, length, file), length);
    fclose(file);
    wr_free(bytes);
}

/* A folder of fonts, three valid and four not, is all that fontconfig finds. */
static void make_fonts(void)
{
    char text[600], folder[300];
    WrError err = { "" };
    if (!getcwd(folder, sizeof folder)) fail_msg("no folder");
    assert_int_equal(mkdir("fonts", 0700), 0);
    copy_damaged(SANS, "fonts/one.ttf", 0);
    copy_damaged(BOLD, "fonts/two words.ttf", 0);
    copy_damaged(INDIAN, "fonts/three.ttf", 0);
    copy_damaged(SANS, "fonts/torn.ttf", -1);
    copy_damaged(BOLD, "fonts/garbled.ttf", 37);
    copy_damaged("fonts/one.ttf", "fonts/a\nline.ttf", 0);
    copy_damaged(SANS, "fonts/a.pfb", 0); /* the same font, presented as Type 1 */
    assert_true(wr_file_write("fonts/empty.ttf", "", 0, &err));
    assert_true(wr_file_write("fonts/text.ttf", "no font", 7, &err));
    const int length =
        snprintf(text, sizeof text,
                 "<?xml version=\"1.0\"?><fontconfig><dir>%.200s/fonts</dir><cachedir>%.200s/cache"
                 "</cachedir></fontconfig>",
                 folder, folder);
    assert_true(wr_file_write("fonts.conf", text, (size_t)length, &err));
    snprintf(text, sizeof text, "%.280s/fonts.conf", folder);
    setenv("FONTCONFIG_FILE", text, 1);
}

static void a_font_that_makes_fontconfig_crash_is_only_an_error(void **state)
{
    (void)state;
#ifdef __SANITIZE_ADDRESS__
    skip(); /* fontconfig runs in this process */
#endif
    WrFontList list = { 0 };
    WrError err = { "" };
    deadly = true;
    assert_false(wr_font_list(&list, &err));
    assert_non_null(strstr(err.text, "crashes on"));
    assert_int_equal(list.count, 0);
    assert_int_equal(getpid(), self);
    deadly = false;
}

static const WrFontEntry *named(const WrFontList *list, const char *ending)
{
    const WrFontEntry *found = NULL;
    for (int i = 0; i < list->count; i++) {
        const char *slash = strrchr(list->data[i].path, '/');
        if (strcmp(slash + 1, ending) == 0) found = &list->data[i];
    }
    return found;
}

static void whole_fonts_are_listed_by_family_and_no_others(void **state)
{
    (void)state;
    WrFontList list = { 0 };
    WrError err = { "" };
    if (!wr_font_list(&list, &err)) fail_msg("%s", err.text);
    const WrFontEntry *sans = named(&list, "one.ttf"), *bold = named(&list, "two words.ttf");
    const WrFontEntry *indian = named(&list, "three.ttf");
    if (!sans || !bold || !indian) fail_msg("%d fonts, not those three", list.count);
    assert_string_equal(sans->family, "DejaVu Sans");
    assert_string_equal(sans->style, "Book");
    assert_string_equal(sans->sample, "DejaVu Sans");
    assert_string_equal(bold->family, "DejaVu Serif");
    assert_string_equal(bold->style, "Bold");
    assert_string_equal(indian->family, "Lohit Devanagari");
    assert_true(sans < bold && bold < indian); /* sorted by name */
    assert_null(named(&list, "a\nline.ttf"));
    assert_null(named(&list, "empty.ttf"));
    assert_null(named(&list, "a.pfb"));
    assert_null(named(&list, "text.ttf"));
    for (int i = 0; i < list.count; i++) assert_true(list.data[i].family[0] != '\0');
    wr_font_list_fini(&list);
}

/* Lohit has Latin letters or not, depending on its version: a sample is the name only if the font has all its
   letters. */
static void a_sample_is_made_of_letters_that_the_font_has(void **state)
{
    (void)state;
    WrFontList list = { 0 };
    WrError err = { "" };
    if (!wr_font_list(&list, &err)) fail_msg("%s", err.text);
    for (int i = 0; i < list.count; i++) {
        int blank = 0;
        FcChar32 c;
        FcPattern *font = FcFreeTypeQuery((const FcChar8 *)list.data[i].path, 0, NULL, &blank);
        FcCharSet *has = NULL;
        if (!font) continue; /* a damaged one that could be read at first */
        assert_int_equal(FcPatternGetCharSet(font, FC_CHARSET, 0, &has), FcResultMatch);
        const FcChar8 *at = (const FcChar8 *)list.data[i].sample;
        assert_true(*at != '\0');
        for (int n; *at; at += n) {
            n = FcUtf8ToUcs4(at, &c, (int)strlen((const char *)at));
            assert_true(n > 0);
            if (c != ' ' && !FcCharSetHasChar(has, c))
                fail_msg("%s has no U+%04X", list.data[i].path, (unsigned)c);
        }
        FcPatternDestroy(font);
    }
    wr_font_list_fini(&list);
}

static int enter(void **state)
{
    self = getpid();
    if (enter_folder(state) != 0) return -1;
    make_fonts();
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_font_that_makes_fontconfig_crash_is_only_an_error),
        cmocka_unit_test(whole_fonts_are_listed_by_family_and_no_others),
        cmocka_unit_test(a_sample_is_made_of_letters_that_the_font_has),
    };
    return cmocka_run_group_tests(tests, enter, remove_folder);
}
