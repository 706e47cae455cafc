/* lightband.h as C99 and as C++: included first, with every initialiser used. Compiling is the test. */
#include "lightband/lightband.h"

uint32_t sizes_of_version_1(void) {
    lb_context_desc context = LB_CONTEXT_DESC_INIT;
    lb_mesh_desc mesh = LB_MESH_DESC_INIT;
    lb_mesh_stats mesh_stats = LB_MESH_STATS_INIT;
    lb_camera_desc camera = LB_CAMERA_DESC_INIT;
    lb_setting_info setting = LB_SETTING_INFO_INIT;
    lb_frame_stats frame_stats = LB_FRAME_STATS_INIT;
    lb_buffer_view view = LB_BUFFER_VIEW_INIT;
    return context.struct_size + mesh.struct_size + mesh_stats.struct_size + camera.struct_size + setting.struct_size +
           frame_stats.struct_size + view.struct_size;
}
