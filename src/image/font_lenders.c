/* Search of installed fonts by their characters, with fontconfig. */
#include "base/memory.h"
#include "image/font.h"
#include "image/font_config.h"
#include "system/path.h"

#include <fontconfig/fontconfig.h>

#include <string.h>

/* Outline fonts, those nearest to these letters first. NULL: fontconfig does not work. */
static FcFontSet *sorted(FcConfig *config, const FcCharSet *wanted, const char *kind,
                         const char *language)
{
    FcResult result;
    FcPattern *pattern = FcPatternCreate();
    FcFontSet *set = NULL;
    bool bold = strstr(kind, "bold") != NULL;
    const char *family = strncmp(kind, "serif", 5) == 0  ? "serif"
                         : strncmp(kind, "mono", 4) == 0 ? "monospace"
                                                         : "sans-serif";
    if (!pattern) return NULL;
    FcPatternAddString(pattern, FC_FAMILY, (const FcChar8 *)family);
    FcPatternAddInteger(pattern, FC_WEIGHT, bold ? FC_WEIGHT_BOLD : FC_WEIGHT_REGULAR);
    FcPatternAddInteger(pattern, FC_SLANT, FC_SLANT_ROMAN);
    FcPatternAddBool(pattern, FC_SCALABLE, FcTrue);
    FcPatternAddCharSet(pattern, FC_CHARSET, wanted);
    if (language) FcPatternAddString(pattern, FC_LANG, (const FcChar8 *)language);
    if (FcConfigSubstitute(config, pattern, FcMatchPattern)) {
        FcDefaultSubstitute(pattern);
        set = FcFontSort(config, pattern, FcFalse, NULL, &result);
    }
    FcPatternDestroy(pattern);
    return set;
}

/* The file of a usable fallback font: outlines, uncoloured, the first face of its file; else NULL. */
static const char *usable(FcPattern *font)
{
    FcChar8 *file = NULL;
    FcBool scalable = FcFalse, outline = FcFalse, coloured = FcFalse;
    WrFileInfo info;
    int index = 0;
    if (FcPatternGetString(font, FC_FILE, 0, &file) != FcResultMatch) return NULL;
    FcPatternGetBool(font, FC_SCALABLE, 0, &scalable);
    FcPatternGetBool(font, FC_OUTLINE, 0, &outline);
    FcPatternGetBool(font, FC_COLOR, 0, &coloured);
    FcPatternGetInteger(font, FC_INDEX, 0, &index);
    if (!scalable || !outline || coloured || (index & 0xffff) != 0) return NULL;
    if (!wr_path_info((const char *)file, &info) || info.bytes > WR_FONT_FILE_MAX) return NULL;
    return (const char *)file;
}

/* The first font with the most wanted characters; removes these from the wanted set. */
static const char *take_best(const FcFontSet *set, FcCharSet **wanted)
{
    FcCharSet *has = NULL, *best_has = NULL;
    const char *best = NULL;
    FcChar32 most = 0;
    for (int i = 0; i < set->nfont; i++) {
        const char *file = usable(set->fonts[i]);
        if (!file || FcPatternGetCharSet(set->fonts[i], FC_CHARSET, 0, &has) != FcResultMatch)
            continue;
        FcChar32 count = FcCharSetIntersectCount(has, *wanted);
        if (count <= most) continue;
        most = count;
        best = file;
        best_has = has;
    }
    if (!best) return NULL;
    FcCharSet *rest = FcCharSetSubtract(*wanted, best_has);
    FcCharSetDestroy(*wanted);
    *wanted = rest;
    return best;
}

int wr_font_lenders(const uint32_t *characters, int count, const char *kind, const char *language,
                    int most, char *paths[])
{
    int found = 0;
    if (!wr_font_config(NULL)) return 0;
    FcConfig *config = FcConfigReference(NULL);
    FcCharSet *wanted = FcCharSetCreate();
    for (int i = 0; i < count && wanted; i++) FcCharSetAddChar(wanted, characters[i]);
    FcFontSet *set = config && wanted ? sorted(config, wanted, kind, language) : NULL;
    while (set && wanted && found < most) {
        const char *file = take_best(set, &wanted);
        if (!file) break;
        paths[found++] = wr_strdup(file);
    }
    if (set) FcFontSetDestroy(set);
    if (wanted) FcCharSetDestroy(wanted);
    if (config) FcConfigDestroy(config);
    return found;
}
