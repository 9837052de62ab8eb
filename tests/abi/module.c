/* A module in C99 that asks every service what it may be asked, and what it may not. */
#include <math.h>
#include <relevo/plugin.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#define EXPECT(condition)                                        \
    do {                                                         \
        if (!(condition)) return complain(__LINE__, #condition); \
    } while (0)
#define NEED(table, type, name)                                      \
    const type* table = (const type*)host_->service(host_, name, 1); \
    EXPECT(table != NULL && table->size >= sizeof *table && table->self != NULL)

static const relevo_host* host_;

static relevo_status complain(int line, const char* what) {
    char text[256];
    snprintf(text, sizeof text, "module.c:%d: %s", line, what);
    host_->fail(host_, text);
    return RELEVO_FAILED;
}

static relevo_status check_host(void) {
    EXPECT(host_->abi_version >> 16 == RELEVO_ABI_MAJOR);
    EXPECT(host_->service(host_, "relevo.weather", 1) == NULL);
    EXPECT(host_->service(host_, "relevo.log", 2) == NULL);
    EXPECT(host_->service(host_, "relevo.log", 0) == NULL);
    EXPECT(host_->service(host_, NULL, 1) == NULL);
    EXPECT(host_->service(NULL, "relevo.log", 1) == NULL);
    host_->fail(NULL, "nobody hears");
    return RELEVO_OK;
}

static relevo_status check_params(void) {
    NEED(params, relevo_params_1, "relevo.params");
    void* self = params->self;
    double value[4] = {9, 9, 9, 9};
    EXPECT(params->get(self, "probe.size", value) == RELEVO_OK && value[0] == 3 && value[3] == 0);
    EXPECT(params->get(self, "probe.nothing", value) == RELEVO_FAILED);
    EXPECT(params->get(self, NULL, value) == RELEVO_FAILED);
    EXPECT(params->get(self, "probe.size", NULL) == RELEVO_FAILED);
    EXPECT(params->get(NULL, "probe.size", value) == RELEVO_FAILED);
    EXPECT(params->set(self, "probe.level", value) == RELEVO_OK);
    EXPECT(params->set(self, "probe.size", value) == RELEVO_FAILED);
    EXPECT(params->set(self, "probe.level", NULL) == RELEVO_FAILED);
    char text[4] = "xyz";
    uint64_t length = 7;
    EXPECT(params->get_text(self, "probe.track", text, sizeof text, &length) == RELEVO_OK);
    EXPECT(text[0] == 0 && length == 0);
    EXPECT(params->get_text(self, "probe.track", NULL, 0, NULL) == RELEVO_FAILED);
    EXPECT(params->get_text(self, "probe.size", text, sizeof text, NULL) == RELEVO_FAILED);
    return RELEVO_OK;
}

static relevo_status check_textures(void) {
    NEED(textures, relevo_texture_1, "relevo.texture");
    NEED(draws, relevo_draw_1, "relevo.draw");
    void* self = textures->self;
    relevo_texture_info info;
    memset(&info, 0, sizeof info);
    info.size = sizeof info;
    info.format = RELEVO_FORMAT_R32F;
    info.width = info.height = 4;
    info.levels = 1;
    info.name = "map";
    relevo_texture texture = 0, other = 0;
    EXPECT(textures->create(self, &info, &texture) == RELEVO_OK && texture != 0);
    EXPECT(textures->create(self, NULL, &other) == RELEVO_FAILED);
    EXPECT(textures->create(self, &info, NULL) == RELEVO_FAILED);
    info.size = 3;
    EXPECT(textures->create(self, &info, &other) == RELEVO_FAILED);
    info.size = sizeof info;
    info.width = 0;
    EXPECT(textures->create(self, &info, &other) == RELEVO_FAILED);

    float four[4] = {1, 2, 3, 4}, all[16];
    relevo_texels texels;
    memset(&texels, 0, sizeof texels);
    texels.size = sizeof texels;
    texels.texture = texture;
    texels.width = texels.height = 2;
    texels.texels = four;
    texels.bytes = sizeof four;
    EXPECT(textures->write(self, &texels) == RELEVO_OK);
    EXPECT(textures->write(self, NULL) == RELEVO_FAILED);
    texels.x = 3;
    EXPECT(textures->write(self, &texels) == RELEVO_FAILED);
    texels.x = 2;
    texels.bytes = 15;
    EXPECT(textures->write(self, &texels) == RELEVO_FAILED);
    texels.bytes = sizeof four;
    texels.texels = NULL;
    EXPECT(textures->write(self, &texels) == RELEVO_FAILED);
    EXPECT(textures->read(self, texture, 0, all, 16) == RELEVO_OK);
    EXPECT(textures->read(self, texture, 0, all, 15) == RELEVO_FAILED);
    EXPECT(textures->read(self, texture, 1, all, 16) == RELEVO_FAILED);
    EXPECT(textures->read(self, texture, 0, NULL, 16) == RELEVO_FAILED);

    relevo_program program = 0;
    EXPECT(draws->program(draws->self, "fill.glsl", &program) == RELEVO_OK && program != 0);
    EXPECT(draws->program(draws->self, "../module.c", &program) == RELEVO_FAILED);
    EXPECT(draws->program(draws->self, NULL, &program) == RELEVO_FAILED);
    EXPECT(draws->program(draws->self, "fill.glsl", NULL) == RELEVO_FAILED);
    relevo_draw draw;
    memset(&draw, 0, sizeof draw);
    draw.size = sizeof draw;
    draw.program = program;
    draw.target = texture;
    draw.values = four;
    draw.value_count = 1;
    EXPECT(draws->draw(draws->self, &draw) == RELEVO_OK);
    EXPECT(draws->draw(draws->self, NULL) == RELEVO_FAILED);
    draw.values = NULL;
    EXPECT(draws->draw(draws->self, &draw) == RELEVO_FAILED);
    draw.value_count = 0;
    draw.input_count = 1;
    EXPECT(draws->draw(draws->self, &draw) == RELEVO_FAILED);
    draw.input_count = RELEVO_MAX_INPUTS + 1;
    EXPECT(draws->draw(draws->self, &draw) == RELEVO_FAILED);
    EXPECT(draws->destroy_program(draws->self, program) == RELEVO_OK);
    EXPECT(draws->destroy_program(draws->self, program) == RELEVO_FAILED);
    EXPECT(textures->destroy(self, texture) == RELEVO_OK);
    EXPECT(textures->destroy(self, texture) == RELEVO_FAILED);
    EXPECT(textures->make_mipmaps(self, texture) == RELEVO_FAILED);
    return RELEVO_OK;
}

static relevo_status check_ground(int in_frame) {
    const relevo_status wanted = in_frame ? RELEVO_OK : RELEVO_FAILED;
    NEED(frames, relevo_frame_1, "relevo.frame");
    NEED(terrain, relevo_terrain_1, "relevo.terrain");
    NEED(heights, relevo_heights_1, "relevo.heights");
    NEED(geo, relevo_geo_1, "relevo.geo");
    relevo_frame frame;
    memset(&frame, 0xff, sizeof frame);
    frame.size = sizeof frame;
    EXPECT(frames->get(frames->self, &frame) == wanted);
    EXPECT(frames->get(frames->self, NULL) == RELEVO_FAILED);
    relevo_box box;
    memset(&box, 0, sizeof box);
    box.size = sizeof box;
    box.right[0] = box.up[1] = box.towards[2] = 1;
    EXPECT(terrain->bounds(terrain->self, &box) == wanted);
    EXPECT(terrain->bounds(terrain->self, NULL) == RELEVO_FAILED);
    EXPECT(terrain->visible_bounds(terrain->self, 1e300, NULL) == RELEVO_FAILED);
    EXPECT(terrain->draw_depth(terrain->self, NULL, 1, 1, NULL) == RELEVO_FAILED);
    relevo_heights about;
    memset(&about, 0, sizeof about);
    about.size = sizeof about;
    EXPECT(heights->describe(heights->self, &about) == wanted);
    EXPECT(heights->describe(heights->self, NULL) == RELEVO_FAILED);
    relevo_nodes nodes;
    memset(&nodes, 0, sizeof nodes);
    nodes.size = sizeof nodes;
    nodes.columns = 3;
    nodes.rows = 2;
    float six[6];
    EXPECT(heights->read(heights->self, &nodes, six, 6) == wanted);
    EXPECT(heights->read(heights->self, &nodes, six, 5) == RELEVO_FAILED);
    EXPECT(heights->read(heights->self, &nodes, NULL, 6) == RELEVO_FAILED);
    EXPECT(heights->read(heights->self, NULL, six, 6) == RELEVO_FAILED);
    nodes.level = 99;
    EXPECT(heights->read(heights->self, &nodes, six, 6) == RELEVO_FAILED);
    nodes.level = 0;
    nodes.columns = -1;
    EXPECT(heights->read(heights->self, &nodes, six, 6) == RELEVO_FAILED);
    double place[3] = {0.01, 0.02, 100}, local[3], back[3];
    EXPECT(geo->to_local(geo->self, place, local) == wanted);
    EXPECT(geo->to_local(geo->self, NULL, local) == RELEVO_FAILED);
    EXPECT(geo->to_local(geo->self, place, NULL) == RELEVO_FAILED);
    if (!in_frame) return RELEVO_OK;
    EXPECT(geo->from_local(geo->self, local, back) == RELEVO_OK);
    for (int i = 0; i < 3; ++i)
        EXPECT(fabs(back[i] - place[i]) < 1e-6);
    EXPECT(frame.width_px > 0 && frame.fov_y_rad > 0 && frame.unix_s > 1e9 && frame.exposure > 0);
    EXPECT(frame.projection[11] == 1 && frame.projection[14] > 0 && frame.view[15] == 1);
    EXPECT(about.columns > 1 && about.rows > 1 && about.levels > 0);
    EXPECT(six[0] == six[0]);
    return RELEVO_OK;
}

static relevo_status check_marks(void) {
    NEED(marks, relevo_marks_1, "relevo.marks");
    void* self = marks->self;
    relevo_mark two[2];
    memset(two, 0, sizeof two);
    two[0].size = two[1].size = sizeof two[0];
    two[0].text = "B\xc3\xa4r";
    two[1].text = "";
    two[1].lat_deg = -90;
    EXPECT(marks->set(self, "places", two, 2) == RELEVO_OK);
    EXPECT(marks->set(self, "places", NULL, 0) == RELEVO_OK);
    EXPECT(marks->set(self, "places", NULL, 1) == RELEVO_FAILED);
    EXPECT(marks->set(self, "others", two, 2) == RELEVO_FAILED);
    EXPECT(marks->set(self, NULL, two, 2) == RELEVO_FAILED);
    EXPECT(marks->set(NULL, "places", two, 2) == RELEVO_FAILED);
    EXPECT(marks->set(self, "places", two, 10000000) == RELEVO_FAILED);
    two[1].text = "\xff";
    EXPECT(marks->set(self, "places", two, 2) == RELEVO_FAILED);
    two[1].text = NULL;
    EXPECT(marks->set(self, "places", two, 2) == RELEVO_FAILED);
    two[1].text = "";
    two[1].lat_deg = 95;
    EXPECT(marks->set(self, "places", two, 2) == RELEVO_FAILED);
    two[1].lat_deg = 0;
    two[1].size = 8;
    EXPECT(marks->set(self, "places", two, 2) == RELEVO_FAILED);
    return RELEVO_OK;
}

static relevo_status create(const relevo_host* host, void** instance) {
    host_ = host;
    *instance = (void*)host;
    if (check_host() != RELEVO_OK || check_params() != RELEVO_OK || check_textures() != RELEVO_OK ||
        check_ground(0) != RELEVO_OK || check_marks() != RELEVO_OK)
        return RELEVO_FAILED;
    return RELEVO_OK;
}

static void destroy(void* instance) {
    (void)instance;
}

static relevo_status prepare(void* instance) {
    (void)instance;
    return check_ground(1);
}

RELEVO_PLUGIN_EXPORT const uint32_t relevo_plugin_abi = RELEVO_ABI_VERSION;

RELEVO_PLUGIN_EXPORT relevo_status relevo_plugin_register(const relevo_host* host,
                                                          relevo_module* module) {
    host_ = host;
    if (host->service(host, "relevo.frame", 1) != NULL)
        return complain(__LINE__, "a registration finds services beside the log");
    module->id = "probe";
    module->create = &create;
    module->destroy = &destroy;
    module->prepare = &prepare;
    return RELEVO_OK;
}
