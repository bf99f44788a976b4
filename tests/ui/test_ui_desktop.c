/* Desktop scale in the formats of other programs: XSETTINGS in both byte orders, built from the specification;
   resources in xrdb's form; damaged ones. */
#include "test.h"

#include "ui/toolkit/desktop_scale.h"

#include <string.h>

typedef struct Block {
    unsigned char bytes[512];
    size_t count;
    int high_first;
} Block;

static void put(Block *b, unsigned value, int size)
{
    for (int i = 0; i < size; i++)
        b->bytes[b->count++] = (unsigned char)(value >> 8 * (b->high_first ? size - 1 - i : i));
}

static void put_text(Block *b, const char *text)
{
    memcpy(b->bytes + b->count, text, strlen(text));
    b->count += strlen(text);
    while (b->count % 4) b->bytes[b->count++] = 0;
}

static void begin(Block *b, const char *name, unsigned type)
{
    put(b, type, 1), put(b, 0, 1), put(b, (unsigned)strlen(name), 2);
    put_text(b, name);
    put(b, 77, 4); /* its serial */
}

static Block block(int high_first, unsigned dpi)
{
    Block b = { .high_first = high_first };
    put(&b, (unsigned)high_first, 1), put(&b, 0, 3), put(&b, 12345, 4), put(&b, 4, 4);
    begin(&b, "Net/ThemeName", 1), put(&b, 7, 4), put_text(&b, "Adwaita");
    begin(&b, "Gtk/Ink", 2), put(&b, 0x1234, 4), put(&b, 0xffff, 4);
    begin(&b, "Xft/DPI2", 0), put(&b, 50 * 1024, 4);
    begin(&b, "Xft/DPI", 0), put(&b, dpi, 4);
    return b;
}

static void settings_of_both_byte_orders(void **state)
{
    (void)state;
    for (int high = 0; high < 2; high++) {
        Block b = block(high, 147456); /* 144 dots per inch, in 1024ths */
        assert_true(wr_desktop_dpi_of_settings(b.bytes, b.count) == 144);
        for (size_t count = 0; count < b.count; count++)
            assert_true(wr_desktop_dpi_of_settings(b.bytes, count) == 0);
        b = block(high, 0xffffffffu); /* -1: the default */
        assert_true(wr_desktop_dpi_of_settings(b.bytes, b.count) == 0);
    }
}

/* Any bytes: no read beyond them, and the result is a scale or none. */
static void damaged_settings(void **state)
{
    (void)state;
    TestRandom random = { 41 };
    for (int i = 0; i < 3000; i++) {
        Block b = block(i & 1, 98304);
        for (int k = 0; k < 3; k++)
            b.bytes[(size_t)(test_random(&random) * (double)b.count)] =
                (unsigned char)(256 * test_random(&random));
        unsigned char *own = malloc(b.count); /* exact size, for sanitizers */
        memcpy(own, b.bytes, b.count);
        const double dpi = wr_desktop_dpi_of_settings(own, b.count);
        assert_true(dpi == 0 || (dpi >= 48 && dpi <= 768));
        free(own);
    }
}

static void resources(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double dpi;
    } cases[] = {
        { "Xft.dpi:\t192\n", 192 },
        { "*customization: -color\nXft.antialias:\t1\nXft.dpi:  120.5  \nXft.hinting: 1\n", 120.5 },
        { "", 0 },
        { "Xft.dpi:", 0 },
        { "Xft.dpi: many\n", 0 },
        { "Xft.dpi: 4\n", 0 },
        { "Xft.dpi: 1e9\n", 0 },
        { "MyXft.dpi: 192\n", 0 },
        { "Xft.dpi2: 192\n", 0 }
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        if (wr_desktop_dpi_of_resources(cases[i].text) != cases[i].dpi)
            fail_msg("%s: %g", cases[i].text, wr_desktop_dpi_of_resources(cases[i].text));
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(settings_of_both_byte_orders),
                                        cmocka_unit_test(damaged_settings),
                                        cmocka_unit_test(resources) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
