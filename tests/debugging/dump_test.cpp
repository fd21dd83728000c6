#include "tests/support/program_fixture.h"

#include <gtest/gtest.h>

using namespace tetrace::test;

namespace {

class Dump : public ProgramTest {
protected:
    /// Whether the backend is a part of this build: it exits with 3 if it is not, and with 0 else.
    bool dumps(const std::string& backend, const std::string& kernel)
    {
        ended_ = run("dump --backend " + backend + " " + kernel + " --out out");
        EXPECT_TRUE(ended_.code == 0 || ended_.code == 3) << ended_.code << ": " << ended_.errors;
        return ended_.code == 0;
    }

    [[nodiscard]] std::string out(const std::string& name) const { return file(("out/" + name).c_str()); }

    /// The file's command in README.txt.
    [[nodiscard]] std::string command_for(const std::string& name) const
    {
        std::string text = out("README.txt");
        text = text.substr(text.find(name + " ("));
        text = text.substr(text.find("    $ ") + 6);
        return text.substr(0, text.find('\n'));
    }

    /// Runs the command of a file of SPIR-V.
    void expect_command_makes(const std::string& name) const
    {
        const std::string spirv = out(name), command = command_for(name);
        ASSERT_GT(spirv.size(), 300u) << name;
        ASSERT_TRUE(command.starts_with("glslangValidator ")) << command;
        const std::string shell = "cd '" + (folder_.path() / "out").string() + "' && rm " + name + " && " + command;
        ASSERT_EQ(std::system((shell + " > /dev/null").c_str()), 0) << command;
        EXPECT_TRUE(out(name) == spirv) << command << " makes other bytes";
    }

    Ended ended_;
};

bool is_installed(const std::string& program)
{
    return std::system(("command -v " + program + " > /dev/null").c_str()) == 0;
}

} // namespace

TEST_F(Dump, of_opencl_is_a_source_without_includes)
{
    if (!dumps("opencl", "--method project --layout half32")) GTEST_SKIP() << ended_.errors;
    const std::string source = out("project_half32.cl");
    EXPECT_TRUE(contains(source, "run_image"));
    EXPECT_FALSE(contains(source, "\n#include")) << "every include is resolved";
    EXPECT_TRUE(contains(out("README.txt"), "-DSTARTS_OUTSIDE"));
    EXPECT_EQ(out("README.txt"), ended_.out) << "it is printed too";
    EXPECT_FALSE(contains(ended_.out, "-cl-fast-relaxed-math"));
    ASSERT_TRUE(dumps("opencl", "--method project --layout half32 --math fast"));
    EXPECT_TRUE(contains(out("README.txt"), "-DMATH_FAST"));
}

TEST_F(Dump, of_vulkan_is_glsl_whose_command_makes_the_very_bytes_of_its_spirv)
{
    if (!dumps("vulkan", "--method maria --layout tet80")) GTEST_SKIP() << ended_.errors;
    EXPECT_FALSE(contains(out("maria_tet80.comp"), "\n#include"));
    if (!is_installed("glslangValidator")) GTEST_SKIP() << "glslangValidator is not installed";
    for (const std::string name :
         {"maria_tet80_exact_trace.spv", "maria_tet80_exact_search_texels.spv", "maria_tet80_exact_trace_parts.spv"})
        expect_command_makes(name);
    ASSERT_TRUE(dumps("vulkan", "--method project --layout half32"));
    for (const std::string name :
         {"project_half32_exact_trace_leaves_texels.spv", "project_half32_exact_trace_left_texels.spv"})
        expect_command_makes(name);
}

TEST_F(Dump, of_a_drivers_bvh_on_vulkan_is_the_glsl_of_ray_queries_and_of_each_stage_of_a_pipeline)
{
    if (!dumps("vulkan", "--layout rt")) GTEST_SKIP() << ended_.errors;
    EXPECT_TRUE(contains(out("single_rt.comp"), "rayQueryEXT"));
    EXPECT_TRUE(contains(out("single_rt.rgen"), "traceRayEXT"));
    if (!is_installed("glslangValidator")) GTEST_SKIP() << "glslangValidator is not installed";
    for (const std::string name : {"single_rt_fast_rays.spv", "single_rt_fast_rays_pipeline.spv",
                                   "single_rt_fast_miss.spv", "single_rt_fast_hit.spv"})
        expect_command_makes(name);
}

TEST_F(Dump, of_cuda_is_a_source_and_the_command_that_makes_ptx)
{
    if (!dumps("cuda", "--method project --layout half32")) GTEST_SKIP() << ended_.errors;
    EXPECT_FALSE(contains(out("project_half32.cu"), "\n#include"));
    EXPECT_TRUE(command_for("project_half32.cu").starts_with("nvcc --ptx ")) << ended_.out;
    EXPECT_TRUE(contains(out("README.txt"), "--fmad=false"));
    const std::string ptx = out("project_half32_exact.ptx");
    if (ptx.empty()) GTEST_SKIP() << "NVRTC is not here";
    EXPECT_TRUE(contains(ptx, ".target sm_75"));
    EXPECT_TRUE(contains(ptx, "trace_tiles_project_half32_exact"));
}

TEST_F(Dump, of_cuda_host_and_of_a_variant_is_one_text_that_its_command_compiles)
{
    if (!dumps("cuda-host", "--method maria --layout tet80")) GTEST_SKIP() << ended_.errors;
    EXPECT_TRUE(contains(out("maria_tet80_exact.cpp"), "extern \"C\" __global__"));
    if (!is_installed("c++")) GTEST_SKIP() << "no C++ compiler";
    const std::string command = command_for("maria_tet80_exact.cpp");
    EXPECT_EQ(run("-c 'cd out && " + command + "'", "/bin/sh").code, 0) << command;
    ASSERT_TRUE(dumps("cuda", "--method maria --layout tet80 --variant other_face/struct"));
    EXPECT_TRUE(contains(out("maria_tet80.cu"), "variant_of_other_face_all"));
    EXPECT_TRUE(command_for("maria_tet80.cu").starts_with("nvcc --ptx ")) << ended_.out;
    EXPECT_EQ(run("dump --backend cuda --variant no/such --out other").code, 2);
}

TEST_F(Dump, of_a_variant_has_the_command_of_the_entry_point)
{
    const std::string variant = "--method maria --layout tet80 --variant other_face/struct ";
    EXPECT_EQ(run("dump --backend vulkan --method maria --layout tet80 --entry tally --out out").code, 2)
        << "no variant";
    EXPECT_EQ(run("dump --backend vulkan --scene cubes --pixel 1,1 --entry tally --out out " + variant).code, 2);
    EXPECT_EQ(run("dump --backend vulkan --layout bvh2 --variant difference_of.3/guard --entry tally --out out").code,
              2)
        << "BVHs lack this task";
    const auto expect_option = [&](const std::string& backend, const std::string& file, const std::string& entry,
                                   const std::string& option) {
        if (!dumps(backend, variant + entry)) return;
        EXPECT_TRUE(contains(command_for(file), option)) << command_for(file);
    };
    expect_option("vulkan", "maria_tet80.comp", "--entry tally", " -DTALLY ");
    expect_option("vulkan", "maria_tet80.comp", "", " -DTRACE ");
    expect_option("opencl", "maria_tet80.cl", "--entry absorb", " -DABSORB ");
    expect_option("opencl", "maria_tet80.cl", "--entry rays", " -DRAYS ");
}

TEST_F(Dump, of_what_has_no_files_is_refused)
{
    for (const std::string arguments : {"--backend openmp", "--backend embree", "--backend opencl --layout embree"}) {
        const Ended ended = run("dump --out out " + arguments);
        EXPECT_EQ(ended.code, 2) << arguments << ended.out;
        EXPECT_FALSE(ended.errors.empty());
        EXPECT_FALSE(std::filesystem::exists(folder_.path() / "out")) << arguments;
    }
    EXPECT_EQ(run("dump --backend cuda").code, 2) << "no folder";
    EXPECT_EQ(run("dump --out out").code, 2) << "no backend";
    EXPECT_EQ(run("dump --backend cuda,vulkan --out out").code, 2) << "two backends";
    write_file(folder_ / "file", "");
    EXPECT_EQ(run("dump --backend cuda --out file").code, 2) << "a file is not a folder";
}
