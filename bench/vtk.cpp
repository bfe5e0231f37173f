// SPDX-License-Identifier: MIT
//
// brume-vtk: VTK's fixed-point ray caster on the scene of run.sh, unlit (it
// has no light march), as a line of the figures of brume-bench. Built where
// libvtk9-dev is installed. It casts on the processor; the steps of its
// Render are called one by one, as the last one puts the image on a display.
#include <vtkCamera.h>
#include <vtkColorTransferFunction.h>
#include <vtkFixedPointRayCastImage.h>
#include <vtkFixedPointVolumeRayCastMapper.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPiecewiseFunction.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkVersion.h>
#include <vtkVolume.h>
#include <vtkVolumeProperty.h>

#include <vtkAutoInit.h>
VTK_MODULE_INIT(vtkRenderingOpenGL2)
VTK_MODULE_INIT(vtkRenderingVolumeOpenGL2)

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>

// The box of active voxels in bytes: VTK's caster has no sparse form.
static void fill(vtkImageData *image, const char *path)
{
    openvdb::initialize();
    openvdb::io::File file(path);
    file.open(false);
    const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(
        file.readGrid(file.beginName().gridName()));
    const openvdb::CoordBBox box = grid->evalActiveVoxelBoundingBox();
    const openvdb::Coord n = box.dim();
    image->SetDimensions(n.x(), n.y(), n.z());
    image->SetOrigin(box.min().x(), box.min().y(), box.min().z());
    image->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
    auto *out = static_cast<unsigned char *>(image->GetScalarPointer());
    const auto accessor = grid->getConstAccessor();
    for (int z = 0; z < n.z(); z++)
        for (int y = 0; y < n.y(); y++)
            for (int x = 0; x < n.x(); x++) {
                const float d =
                    accessor.getValue(box.min() + openvdb::Coord(x, y, z));
                *out++ = static_cast<unsigned char>(
                    std::lround(255 * std::min(1.0F, std::max(0.0F, d))));
            }
}

static void set_camera(vtkRenderer *renderer)
{
    vtkCamera *camera = renderer->GetActiveCamera();
    camera->SetPosition(300, 40, 455);
    camera->SetFocalPoint(130, 84, 130);
    camera->SetViewUp(0, 1, 0);
    camera->SetViewAngle(25);
    camera->SetClippingRange(1, 2000);
}

// White of extinction 0.05 a voxel at density 1.
static void set_property(vtkVolumeProperty *property, bool linear)
{
    vtkNew<vtkPiecewiseFunction> opacity;
    vtkNew<vtkColorTransferFunction> colour;
    for (int i = 0; i <= 255; i += 5)
        opacity->AddPoint(i, 1 - std::exp(-0.05 * i / 255));
    colour->AddRGBPoint(0, 1, 1, 1);
    property->SetScalarOpacity(opacity);
    property->SetColor(colour);
    property->SetScalarOpacityUnitDistance(1);
    property->ShadeOff();
    if (linear)
        property->SetInterpolationTypeToLinear();
    else
        property->SetInterpolationTypeToNearest();
}

struct caster {
    vtkNew<vtkImageData> image;
    vtkNew<vtkFixedPointVolumeRayCastMapper> mapper;
    vtkNew<vtkVolume> volume;
    vtkNew<vtkRenderer> renderer;
    vtkNew<vtkRenderWindow> window;

    void begin(bool linear)
    {
        vtkNew<vtkVolumeProperty> property;
        set_property(property, linear);
        mapper->SetInputData(image);
        mapper->SetSampleDistance(2);
        mapper->AutoAdjustSampleDistancesOff();
        mapper->LockSampleDistanceToInputSpacingOff();
        mapper->IntermixIntersectingGeometryOff();
        mapper->SetImageSampleDistance(1);
        mapper->SetNumberOfThreads(1);
        volume->SetMapper(mapper);
        volume->SetProperty(property);
        renderer->AddVolume(volume);
        window->SetSize(960, 540);
        window->AddRenderer(renderer);
        set_camera(renderer);
    }

    bool render()
    {
        mapper->Update();
        if (!mapper->PerImageInitialization(renderer, volume, 0, nullptr,
                                            nullptr, nullptr))
            return false;
        mapper->PerVolumeInitialization(renderer, volume);
        mapper->PerSubVolumeInitialization(renderer, volume, 0);
        mapper->RenderSubVolume();
        return true;
    }

    // Mean of the frame in 1/255, to see that there is a picture: 15 bits.
    double mean() const
    {
        vtkFixedPointRayCastImage *drawn = mapper->GetRayCastImage();
        int used[2], memory[2];
        drawn->GetImageInUseSize(used);
        drawn->GetImageMemorySize(memory);
        double sum = 0;
        for (int y = 0; y < used[1]; y++)
            for (int x = 0; x < used[0]; x++)
                sum += drawn->GetImage()[4 * (y * memory[0] + x)];
        return sum * 255 / 32767 / (960 * 540);
    }
};

static double milliseconds()
{
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) +
           1e-6 * static_cast<double>(t.tv_nsec);
}

int main(int argc, char **argv)
{
    if (argc != 3) {
        std::puts("usage: brume-vtk CLOUD.vdb RUNS");
        return 2;
    }
    std::puts("name,ms,bytes,level");
    for (const bool linear : {false, true}) {
        caster c;
        fill(c.image, argv[1]);
        c.begin(linear);
        std::vector<double> ms;
        for (int run = 0; run <= std::atoi(argv[2]); run++) {
            const double from = milliseconds();
            if (!c.render())
                return 1;
            if (run > 0) // the first one also finds gradients and leaps
                ms.push_back(milliseconds() - from);
        }
        std::sort(ms.begin(), ms.end());
        std::printf("%s,%.1f,%lld,%.2f\n",
                    linear ? "vtk-linear" : "vtk-nearest", ms[ms.size() / 2],
                    1024LL *
                        static_cast<long long>(c.image->GetActualMemorySize()),
                    c.mean());
    }
}
