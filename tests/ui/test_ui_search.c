/* The search: words that artists of Krita, GIMP, Photoshop, Blender, Substance and ZBrush type, each with its expected first
   result; and every row of the panels, which must be found by its label, opened and highlighted. */
#include "test.h"

#include "window_walk.h"

#include "ui/app/state/search_words.h"
#include "ui/panels/panel_search.h"
#include "ui/toolkit/gui_rows.h"

typedef struct Wanted {
    const char *typed, *label; /* English label of the first result */
    const char *section;       /* of its panel; NULL: any */
} Wanted;

static const Wanted in_english[] = {
    { "brush", "Brush", NULL },
    { "paintbrush", "Brush", NULL },
    { "paint brush", "Brush", NULL },
    { "blur tool", "Smooth", NULL },
    { "soften", "Smooth", NULL },
    { "relax", "Smooth", NULL },
    { "smudge", "Smear", NULL },
    { "smugde", "Smear", NULL },
    { "finger", "Smear", NULL },
    { "wet brush", "Smear", NULL },
    { "nudge", "Smear", NULL },
    { "clone stamp", "Clone", NULL },
    { "healing", "Clone", NULL },
    { "rubber stamp", "Clone", NULL },
    { "bucket", "Fill an area", NULL },
    { "paint bucket", "Fill an area", NULL },
    { "flood fill", "Fill an area", NULL },
    { "fill tool", "Fill an area", NULL },
    { "gradient tool", "Ramp", NULL },
    { "radial gradient", "Ramp", NULL },
    { "circle", "Ellipse", NULL },
    { "square", "Rectangle", NULL },
    { "polygon", "Polygon", NULL },
    { "pen tool", "Bezier path", NULL },
    { "spline", "Bezier path", NULL },
    { "stamp", "Stamp", NULL },
    { "alpha", "Stamp", NULL },
    { "alphas", "Stamp", NULL },
    { "stencil", "Stamp", NULL },
    { "decal", "Stamp", NULL },
    { "decals", "Stamp", NULL },
    { "import alpha", "Open a picture as a stamp...", NULL },
    { "procedural", "Generate", NULL },
    { "marquee", "Rectangle selection", NULL },
    { "lasso", "Lasso selection", NULL },
    { "laso", "Lasso selection", NULL },
    { "circle select", "Ellipse selection", NULL },
    { "transform", "Free transform", NULL },
    { "gizmo", "Free transform", NULL },
    { "eyedropper", "Pick height", NULL },
    { "eye dropper", "Pick height", NULL },
    { "color picker", "Pick height", NULL },
    { "colour picker", "Pick height", NULL },
    { "pan", "Move the table", NULL },
    { "hand tool", "Move the table", NULL },
    { "magnifier", "Zoom", NULL },
    { "zoom", "Zoom", NULL },
    { "bigger brush", "Larger brush", NULL },
    { "brush size up", "Larger brush", NULL },
    { "eraser", "Erase", NULL },
    { "erasor", "Erase", NULL },
    { "copy", "Copy", NULL },
    { "rubber", "Rubber", NULL },
    { "undo", "Undo", NULL },
    { "redo", "Redo", NULL },
    { "step back", "Undo", NULL },
    { "zadd", "Swap raise and lower", NULL },
    { "zsub", "Swap raise and lower", NULL },
    { "invert brush", "Swap raise and lower", NULL },
    { "carve", "Swap raise and lower", NULL },
    { "flatten brush", "Paint to a height", NULL },
    { "planar", "Paint to a height", NULL },
    { "brush dynamics", "Curves of the brush...", NULL },
    { "pressure curve", "Curves of the brush...", NULL },
    { "brush settings", "Curves of the brush...", NULL },
    { "save brush", "Save brush as a preset...", NULL },
    { "custom brush", "Save brush as a preset...", NULL },
    { "brush presets", "Brushes", NULL },
    { "brush library", "Brushes", NULL },
    { "symmetry", "Symmetry...", NULL },
    { "symetry", "Symmetry...", NULL },
    { "radial symmetry", "Symmetry...", NULL },
    { "mandala", "Symmetry...", NULL },
    { "mirror brush", "Symmetry...", NULL },
    { "line tool", "Straight lines", NULL },
    { "ruler", "Straight lines", NULL },
    { "texture paint", "Paint on the patch", NULL },
    { "polypaint", "Paint on the patch", NULL },
    { "projection painting", "Paint on the patch", NULL },
    { "stabilizer", "Stabilizer", NULL },
    { "stabiliser", "Stabilizer", NULL },
    { "lazy mouse", "Stabilizer", NULL },
    { "lazymouse", "Stabilizer", NULL },
    { "deselect", "Select none", NULL },
    { "select all", "Select all", NULL },
    { "invert selection", "Invert selection", NULL },
    { "expand selection", "Grow selection...", NULL },
    { "contract selection", "Shrink selection...", NULL },
    { "feather selection", "Feather selection...", NULL },
    { "magic wand", "Select by height...", NULL },
    { "color range", "Select by height...", NULL },
    { "new layer", "New layer", NULL },
    { "add layer", "New layer", NULL },
    { "duplicate layer", "Duplicate layer", NULL },
    { "copy layer", "Duplicate layer", NULL },
    { "instance", "Linked copy", NULL },
    { "smart object", "Linked copy", NULL },
    { "remove layer", "Delete layer", NULL },
    { "layer name", "Rename layer", NULL },
    { "rasterise", "Rasterize layer", NULL },
    { "rasterize", "Rasterize layer", NULL },
    { "layer group", "Group layers", NULL },
    { "folder", "Group layers", NULL },
    { "merge down", "Merge layer down", NULL },
    { "flatten image", "Flatten all layers", NULL },
    { "merge visible", "Flatten all layers", NULL },
    { "hide layer", "Layer is shown", NULL },
    { "layer visibility", "Layer is shown", NULL },
    { "lock layer", "Layer is locked", NULL },
    { "solo", "Show layer alone", NULL },
    { "isolate layer", "Show layer alone", NULL },
    { "layer mask", "Mask from selection", NULL },
    { "layer masks", "Mask from selection", NULL },
    { "white mask", "Mask that shows all", NULL },
    { "reveal all", "Mask that shows all", NULL },
    { "black mask", "Mask that hides all", NULL },
    { "smart mask", "Live mask...", NULL },
    { "mask generator", "Live mask...", NULL },
    { "procedural mask", "Live mask...", NULL },
    { "edit mask", "Paint on the mask", NULL },
    { "invert mask", "Invert mask", NULL },
    { "canvas size", "New table...", NULL },
    { "texture size", "New table...", NULL },
    { "make seamless", "Make seamless", NULL },
    { "seam view", "Offset by half a cell", NULL },
    { "import obj", "Import mesh...", NULL },
    { "load model", "Import mesh...", NULL },
    { "custom mesh", "Import mesh...", NULL },
    { "bake high poly", "Bake a detailed mesh...", NULL },
    { "bake maps", "Bake a detailed mesh...", NULL },
    { "baking", "Bake a detailed mesh...", NULL },
    { "load heightmap", "Import heights...", NULL },
    { "import height map", "Import heights...", NULL },
    { "heightmap", "Export...", NULL },
    { "height map", "Export...", NULL },
    { "export png", "Export...", NULL },
    { "texture set", "Export maps...", NULL },
    { "export textures", "Export maps...", NULL },
    { "pbr maps", "Export maps...", NULL },
    { "screenshot", "Render a picture...", NULL },
    { "render", "Render a picture...", NULL },
    { "animation", "Save a turntable as a film...", NULL },
    { "video", "Save a turntable as a film...", NULL },
    { "macro", "Save history as script...", NULL },
    { "new document", "New", NULL },
    { "open file", "Open...", NULL },
    { "save", "Save", NULL },
    { "save as", "Save as...", NULL },
    { "settings", "Preferences...", NULL },
    { "options", "Preferences...", NULL },
    { "prefernces", "Preferences...", NULL },
    { "fit to screen", "Fit the cell", NULL },
    { "actual size", "100 %", NULL },
    { "flip canvas", "Mirror the view", NULL },
    { "rotate canvas", "Turn the table left", NULL },
    { "wrap around mode", "Copies in rows and columns", NULL },
    { "tiled view", "Copies in rows and columns", NULL },
    { "tile preview", "Copies in rows and columns", NULL },
    { "half drop", "Copies in a half-drop", NULL },
    { "hide panels", "Panels", NULL },
    { "split view", "Table and patch", NULL },
    { "3d view", "Patch alone", NULL },
    { "grayscale", "Grey", NULL },
    { "greyscale", "Grey", NULL },
    { "contour lines", "Contour lines", NULL },
    { "show grid", "Grid over the table", NULL },
    { "snapping", "Grid over the table", NULL },
    { "turntable", "Turning patch", NULL },
    { "reset view", "Reset the camera", NULL },
    { "orthographic", "Perspective", NULL },
    { "ortho", "Perspective", NULL },
    { "frame selected", "Fill the picture", NULL },
    { "floor", "Ground", NULL },
    { "shadow catcher", "Ground", NULL },
    { "fullscreen", "Full screen", NULL },
    { "full screen", "Full screen", NULL },
    { "pen pressure", "Pressure", NULL },
    { "stylus", "Tablet tester...", NULL },
    { "wacom", "Tablet tester...", NULL },
    { "manual", "Guide", NULL },
    { "documentation", "Guide", NULL },
    { "tutorial", "Guide", NULL },
    { "version", "About Wrinkle", NULL },
    { "dark mode", "Dark colours of the window", NULL },
    { "dark theme", "Dark colours of the window", NULL },
    { "light theme", "Light colours of the window", NULL },
    { "preview model", "Patch", NULL },
    { "primitive", "Patch", NULL },
    { "tiling", "Repeat u, v", NULL },
    { "uv scale", "Repeat u, v", NULL },
    { "texture repeat", "Repeat u, v", NULL },
    { "material", "Material", NULL },
    { "shader", "Material", NULL },
    { "matcap", "Material", NULL },
    { "brdf", "Reflection", NULL },
    { "shading model", "Reflection", NULL },
    { "roughness", "Roughness", NULL },
    { "rougness", "Roughness", NULL },
    { "roughnes", "Roughness", NULL },
    { "glossiness", "Roughness", NULL },
    { "metallic", "Metalness", NULL },
    { "metalness", "Metalness", NULL },
    { "metallness", "Metalness", NULL },
    { "ior", "IOR", NULL },
    { "fresnel", "IOR", NULL },
    { "refraction", "IOR", NULL },
    { "specular", "Specular", NULL },
    { "specualr", "Specular", NULL },
    { "albedo", "Colours", NULL },
    { "base color", "Colours", NULL },
    { "base colour", "Colours", NULL },
    { "diffuse map", "Colours", NULL },
    { "color ramp", "Colours by height", NULL },
    { "gradient map", "Colours by height", NULL },
    { "self shadowing", "Self-shadowing", NULL },
    { "ambient occlusion", "Ambient occlusion", NULL },
    { "ambient oclusion", "Ambient occlusion", NULL },
    { "ao", "Ambient occlusion", NULL },
    { "parallax", "Parallax", NULL },
    { "paralax", "Parallax", NULL },
    { "pom", "Parallax", NULL },
    { "displacement", "Displacement", NULL },
    { "displacment", "Displacement", NULL },
    { "tessellation", "Displacement", NULL },
    { "bump strength", "Height", "BUMP" },
    { "bump height", "Height", "BUMP" },
    { "displacement scale", "Height", "BUMP" },
    { "normal strength", "Height", "BUMP" },
    { "add lamp", "Add a light", NULL },
    { "spotlight", "Add a light", NULL },
    { "new light", "Add a light", NULL },
    { "area light", "Softness", "LIGHT" },
    { "soft shadows", "Softness", "LIGHT" },
    { "shadows", "Shadows of objects", NULL },
    { "cast shadow", "Shadows of objects", NULL },
    { "studio lights", "Presets", "LIGHT" },
    { "light presets", "Presets", "LIGHT" },
    { "three point lighting", "Presets", "LIGHT" },
    { "exposure", "Exposure", NULL },
    { "exposre", "Exposure", NULL },
    { "tonemapping", "Highlights", NULL },
    { "filmic", "Highlights", NULL },
    { "hdri", "Kind", "ENVIRONMENT" },
    { "hdr", "Kind", "ENVIRONMENT" },
    { "skybox", "Kind", "ENVIRONMENT" },
    { "environment map", "Kind", "ENVIRONMENT" },
    { "ibl", "Kind", "ENVIRONMENT" },
    { "opacity", "Opacity", NULL },
    { "opactiy", "Opacity", NULL },
    { "transparency", "Opacity", NULL },
    { "hardness", "Hardness", NULL },
    { "falloff", "Hardness", NULL },
    { "brush spacing", "Spacing", NULL },
    { "airbrush", "Build up", NULL },
    { "pen sensitivity", "Pressure", NULL },
    { "brush size", "Size", NULL },
    { "blend mode", "Blend", NULL },
    { "blending modes", "Blend", NULL },
    { "texel density", "Cell", NULL },
    { "physical size", "Cell", NULL },
    { "save camera", "Keep this view", NULL },
    { "flip horizontal", "Flip left to right", NULL },
    { "mirror horizontally", "Flip left to right", NULL },
    { "flip vertical", "Flip top to bottom", NULL },
    { "crop", "Crop", NULL },
    { "image size", "Resize", NULL },
    { "resample", "Resize", NULL },
    { "upscale", "Resize", NULL },
    { "levels", "Levels", NULL },
    { "histogram", "Levels", NULL },
    { "curves", "Curves", NULL },
    { "negative", "Invert", NULL },
    { "normalize", "Normalise", NULL },
    { "auto levels", "Normalise", NULL },
    { "blur", "Gaussian blur", NULL },
    { "gausian blur", "Gaussian blur", NULL },
    { "unsharp mask", "Sharpen", NULL },
    { "sharpen", "Sharpen", NULL },
    { "despeckle", "Median", NULL },
    { "denoise", "Median", NULL },
    { "erode", "Erode", NULL },
    { "distort", "Warp", NULL },
    { "liquify", "Warp", NULL },
    { "turbulence", "Warp", NULL },
    { "brick", "Brick", NULL },
    { "brick wall", "Bricks", NULL },
    { "masonry", "Bricks", NULL },
    { "mosaic", "Tiles", NULL },
    { "floor tiles", "Tiles", NULL },
    { "honeycomb", "Hexagons", NULL },
    { "hexagon", "Hexagons", NULL },
    { "wood planks", "Planks", NULL },
    { "parquet", "Planks", NULL },
    { "roof", "Shingles", NULL },
    { "fish scales", "Scales", NULL },
    { "dragon skin", "Scales", NULL },
    { "fabric", "Weave", NULL },
    { "cloth", "Cloth", NULL },
    { "knitted", "Weave", NULL },
    { "carbon fiber", "Weave", NULL },
    { "denim", "Weave", NULL },
    { "braid", "Rope", NULL },
    { "chainmail", "Chain", NULL },
    { "checkerboard", "Checks", NULL },
    { "ripples", "Waves", NULL },
    { "diamond plate", "Knurling", NULL },
    { "polka dots", "Dots", NULL },
    { "rivets", "Dots", NULL },
    { "voronoi", "Voronoi cells", NULL },
    { "worley", "Voronoi cells", NULL },
    { "cellular", "Voronoi cells", NULL },
    { "cobblestone", "Cracks", NULL },
    { "mud cracks", "Cracks", NULL },
    { "stone wall", "Cracks", NULL },
    { "scuffs", "Scratches", NULL },
    { "perlin noise", "Perlin", NULL },
    { "clouds", "Perlin", NULL },
    { "fbm", "Perlin", NULL },
    { "typography", "Text", NULL },
    { "lettering", "Text", NULL },
    { "engraving", "Text", NULL },
    { "bevel", "Edge", NULL },
    { "emboss", "Edge", NULL },
    { "chamfer", "Edge", NULL },
    { "donut", "Torus", NULL },
    { "dome", "Sphere", NULL },
    { "mountains", "Fractal", NULL },
    { "landscape", "Fractal", NULL },
    { "geotiff", "Elevation", NULL },
    { "hydraulic erosion", "Rain", NULL },
    { "erosion", "Rain", NULL },
    { "thermal erosion", "Scree", NULL },
    { "posterize", "Terraces", NULL },
    { "photo to heightmap", "Photo", NULL },
    { "image to height", "Photo", NULL },
    { "height from normal", "Normal map", NULL },
    { "svg", "Vector drawing", NULL },
    { "logo", "Vector drawing", NULL },
    { "kitbash", "Mesh file", NULL },
    { "lathe", "Revolution", NULL },
    { "tileable", "Make seamless", NULL },
    { "seamless", "Make seamless", NULL },
    { "template", "Begin with", NULL },
    { "live link", "Live: write again after each pause", NULL },
    { "hotkeys", "Habits", NULL },
    { "copy merged", "Copy the visible result", NULL },
    { "gold", "Gold", NULL },
    { "china", "Porcelain", NULL },
    { "aluminum", "Metal", NULL },
    { "crevices", "Cavity", NULL },
    { "slope map", "Steepness", NULL },
    { "anti aliasing", "Antialiasing", NULL },
    { "antialiasing", "Antialiasing", NULL },
    { "msaa", "Antialiasing", NULL },
};

/* Typed in a German window. */
static const Wanted in_german[] = {
    { "pinsel", "Brush", NULL },
    { "radierer", "Erase", NULL },
    { "radiergummi", "Erase", NULL },
    { "verwischen", "Smear", NULL },
    { "ebene", "New layer", NULL },
    { "neue ebene", "New layer", NULL },
    { "ebenenmaske", "Mask from selection", NULL },
    { "deckkraft", "Opacity", NULL },
    { "härte", "Hardness", NULL },
    { "haerte", "Hardness", NULL },
    { "rauheit", "Roughness", NULL },
    { "rauigkeit", "Roughness", NULL },
    { "umgebungsverdeckung", "Ambient occlusion", NULL },
    { "verdeckung", "Ambient occlusion", NULL },
    { "verschiebung", "Displacement", NULL },
    { "weichzeichnen", "Gaussian blur", NULL },
    { "schärfen", "Sharpen", NULL },
    { "kachelbar", "Make seamless", NULL },
    { "nahtlos", "Edges", NULL },
    { "auswahl umkehren", "Invert selection", NULL },
    { "rückgängig", "Undo", NULL },
    { "wiederholen", "Redo", NULL },
    { "ziegel", "Bricks", NULL },
    { "kopfsteinpflaster", "Cracks", NULL },
    { "stoff", "Cloth", NULL },
    { "leinwandgröße", "New table...", NULL },
    { "einstellungen", "Preferences...", NULL },
    { "speichern unter", "Save as...", NULL },
    { "öffnen", "Open...", NULL },
    { "licht hinzufügen", "Add a light", NULL },
    { "schatten", "Shadows of objects", NULL },
    { "belichtung", "Exposure", NULL },
    { "spiegeln", "Flip left to right", NULL },
    { "symmetrie", "Symmetry...", NULL },
    { "zauberstab", "Select by height...", NULL },
    { "füllwerkzeug", "Fill an area", NULL },
    { "eimer", "Fill an area", NULL },
    { "pipette", "Pick height", NULL },
    { "vollbild", "Full screen", NULL },
};

/* Typed in a French window. */
static const Wanted in_french[] = {
    { "pinceau", "Brush", NULL },
    { "gomme", "Erase", NULL },
    { "doigt", "Smear", NULL },
    { "étaler", "Smear", NULL },
    { "calque", "New layer", NULL },
    { "nouveau calque", "New layer", NULL },
    { "masque de calque", "Mask from selection", NULL },
    { "opacité", "Opacity", NULL },
    { "opacite", "Opacity", NULL },
    { "dureté", "Hardness", NULL },
    { "rugosité", "Roughness", NULL },
    { "occlusion ambiante", "Ambient occlusion", NULL },
    { "déplacement", "Displacement", NULL },
    { "flou gaussien", "Gaussian blur", NULL },
    { "netteté", "Sharpen", NULL },
    { "sans raccord", "Edges", NULL },
    { "raccordable", "Make seamless", NULL },
    { "intervertir la sélection", "Invert selection", NULL },
    { "annuler", "Undo", NULL },
    { "rétablir", "Redo", NULL },
    { "briques", "Bricks", NULL },
    { "pavés", "Cracks", NULL },
    { "tissu", "Weave", NULL },
    { "taille du canevas", "New table...", NULL },
    { "paramètres", "Preferences...", NULL },
    { "enregistrer sous", "Save as...", NULL },
    { "ouvrir", "Open...", NULL },
    { "ajouter une lumière", "Add a light", NULL },
    { "ombres", "Shadows of objects", NULL },
    { "exposition", "Exposure", NULL },
    { "miroir horizontal", "Flip left to right", NULL },
    { "symétrie", "Symmetry...", NULL },
    { "baguette magique", "Select by height...", NULL },
    { "pot de peinture", "Fill an area", NULL },
    { "pipette", "Pick height", NULL },
    { "plein écran", "Full screen", NULL },
    { "carte d'environnement", "Kind", "ENVIRONMENT" },
    { "carte d’environnement", "Kind", "ENVIRONMENT" },
    { "œil", "Layer is shown", NULL },
    { "stabilisateur", "Stabilizer", NULL },
    { "tampon", "Stamp", NULL },
    { "nid d'abeilles", "Hexagons", NULL },
    { "bosses", "Height", "BUMP" },
};

#define MOST 40

static bool is_label(const char *shown, const char *english)
{
    return strcmp(shown, wr_words(english)) == 0;
}

static void each_is_first(const char *language, const Wanted *wanted, int count)
{
    Walk walk;
    WrSearchHit hits[MOST];
    int wrong = 0;
    walk_open(&walk, language);
    wr_gui_reports_all = false;
    walk_frame(&walk);
    if (strcmp(wr_words_language(), language) != 0) { /* a build without msgfmt */
        walk_close(&walk);
        skip();
    }
    wr_search_index_update(walk.app);
    const WrSearchIndex *index = &walk.app->finder->index;
    for (int i = 0; i < count; i++) {
        const Wanted *w = &wanted[i];
        const int found = wr_search_index_find(index, w->typed, hits, MOST);
        const WrSearchEntry *first = found > 0 ? &index->entries.data[hits[0].entry] : NULL;
        if (first && is_label(first->label, w->label) &&
            (!w->section || (first->section && strcmp(first->section, w->section) == 0)))
            continue;
        wrong++;
        printf("\"%s\" finds", w->typed);
        for (int k = 0; k < found && k < 3; k++) {
            const WrSearchEntry *e = &index->entries.data[hits[k].entry];
            printf(" \"%s\" (%s; %d),", e->label, e->where, hits[k].score);
        }
        printf(" and not \"%s\"\n", wr_words(w->label));
    }
    walk_close(&walk);
    assert_int_equal(wrong, 0);
}

static void words_of_artists_find_their_things_first(void **state)
{
    (void)state;
    assert_true(WR_LENGTH(in_english) + WR_LENGTH(in_german) >= 300);
    each_is_first("en", in_english, WR_LENGTH(in_english));
}

static void german_words_find_their_things_first(void **state)
{
    (void)state;
    each_is_first("de", in_german, WR_LENGTH(in_german));
}

static void french_words_find_their_things_first(void **state)
{
    (void)state;
    each_is_first("fr", in_french, WR_LENGTH(in_french));
}

/* ---- rows ---- */

static bool is_in_window(const WrApp *app, const float place[4])
{
    return place[2] > 0 && place[3] > 0 && place[0] + place[2] > 0 && place[1] >= 0 &&
           place[0] < (float)app->width && place[1] + place[3] <= (float)app->height + 1;
}

static bool opens_lit(Walk *walk, const WrSearchEntry *entry)
{
    WrApp *app = walk->app;
    float place[4];
    app->file->clean_revision = wr_session_revision(walk->session);
    wr_search_index_open(app, entry);
    for (int i = 0; i < 12 && wr_gui_light_left(app->gui) == 0; i++) {
        wr_deferred_run(app);
        walk_frame(walk);
    }
    const bool lit = wr_gui_lit_row(app->gui, place) && is_in_window(app, place);
    walk_close_dialog(walk);
    return lit;
}

/* The rows of tabs, tool options and dialogs as they are drawn; those of generators and operations by a sample. */
static void every_row_is_found_opened_and_lit(void **state)
{
    (void)state;
    Walk walk;
    WrSearchHit hits[MOST];
    int rows = 0, wrong = 0;
    walk_open(&walk, "en");
    wr_gui_reports_all = false;
    wr_gui_unseen = true;
    walk_frame(&walk);
    wr_search_index_update(walk.app);
    const WrSearchIndex *index = &walk.app->finder->index;
    for (int i = 0; i < index->entries.count; i++) {
        const WrSearchEntry *e = &index->entries.data[i];
        if (e->kind != WR_SEARCH_ROW || e->hidden) continue;
        const int count = wr_search_index_find(index, e->label, hits, MOST);
        bool found = false;
        for (int k = 0; k < count; k++) found |= hits[k].entry == i;
        const bool lit = opens_lit(&walk, e);
        if (!found || !lit)
            printf("%s (%s): %s\n", e->label, e->where, found ? "not lit" : "not found"), wrong++;
        rows++;
    }
    wr_gui_unseen = false;
    walk_close(&walk);
    printf("%d rows\n", rows);
    assert_int_equal(wrong, 0);
    assert_true(rows > 120);
}

/* An undo, say, adds or removes rows above the one that was found: the row stays where it was seen. */
static void a_found_row_stays_in_place_when_rows_come_above_it(void **state)
{
    (void)state;
    static const char *const surfaces[] = { "surface revolution", "surface plane",
                                            "surface torus" };
    Walk walk;
    WrSearchHit hits[MOST];
    float before[4], after[4];
    walk_open(&walk, "en");
    wr_gui_reports_all = false;
    walk_frame(&walk);
    wr_search_index_update(walk.app);
    const WrSearchIndex *index = &walk.app->finder->index;
    assert_true(wr_search_index_find(index, "bump height", hits, MOST) > 0);
    int stayed = 0;
    for (int i = 0; i < 30 && stayed < 3;
         i++) { /* on a busy machine the frame may be gone before the pictures are drawn */
        assert_true(opens_lit(&walk, &index->entries.data[hits[0].entry]));
        walk_frame(&walk);
        const bool lit = wr_gui_lit_row(walk.app->gui, before);
        WrError err = { 0 };
        if (!wr_session_run(walk.session, surfaces[i % 3], &err)) fail_msg("%s", err.text);
        for (int k = 0; k < 6; k++) walk_frame(&walk);
        if (!lit || !wr_gui_lit_row(walk.app->gui, after)) continue;
        assert_memory_equal(before, after, sizeof before);
        stayed++;
    }
    assert_int_equal(stayed, 3);
    walk_close(&walk);
}

/* A row of the table of synonyms whose label is not in the program serves nobody. */
static void every_synonym_has_its_thing(void **state)
{
    (void)state;
    Walk walk;
    int lacking = 0;
    walk_open(&walk, "en");
    wr_gui_reports_all = false;
    walk_frame(&walk);
    wr_search_index_update(walk.app);
    const WrSearchIndex *index = &walk.app->finder->index;
    for (const WrSearchWords *w = wr_search_words; w->label; w++) {
        bool there = false;
        for (int i = 0; i < index->entries.count && !there; i++) {
            const char *label = index->entries.data[i].label;
            const char *own = strchr(w->label, '/') ? strchr(w->label, '/') + 1 : w->label;
            const size_t length = strlen(own);
            there = strncmp(label, own, length) == 0 &&
                    (!label[length] || strcmp(label + length, "...") == 0);
        }
        if (!there) printf("nothing is called \"%s\"\n", w->label), lacking++;
    }
    /* rows that are hidden now name a section that the tab has */
    for (int i = 0; i < index->entries.count; i++) {
        const WrSearchEntry *hidden = &index->entries.data[i];
        bool there = !hidden->hidden || !hidden->section[0];
        for (int k = 0; k < index->entries.count && !there; k++) {
            const WrSearchEntry *e = &index->entries.data[k];
            there = !e->hidden && e->tab && e->row && strcmp(e->tab, hidden->tab) == 0 &&
                    strcmp(e->section, hidden->section) == 0;
        }
        if (!there)
            printf("no section \"%s\" for \"%s\"\n", hidden->section, hidden->label), lacking++;
    }
    walk_close(&walk);
    assert_int_equal(lacking, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(words_of_artists_find_their_things_first),
                                        cmocka_unit_test(german_words_find_their_things_first),
                                        cmocka_unit_test(french_words_find_their_things_first),
                                        cmocka_unit_test(every_row_is_found_opened_and_lit),
                                        cmocka_unit_test(
                                            a_found_row_stays_in_place_when_rows_come_above_it),
                                        cmocka_unit_test(every_synonym_has_its_thing) };
    return cmocka_run_group_tests(tests, enter_window, remove_folder);
}
