/**
 * @class vtkFiberPhantom
 * @brief A digital CT image of one damaged hollow fiber whose walls are known.
 *
 * A source for trying and for judging the reconstruction of tubular surfaces: it makes an image
 * that looks like the scan of a wood or cellulose fiber, and the smooth walls a reconstruction
 * should recover. The fiber runs along x; it bends and twists, its section turns from an ellipse
 * to a collapsed kidney, its wall varies in thickness, and its ends are cut open or closed by
 * rounded caps of the wall's thickness. On top comes the damage: rough walls, through holes and
 * slits, blind pits, crooked tunnels, cavities within the wall, debris inside and outside (loose,
 * adhering, fibrils), then blur, ring artifacts, shading and noise.
 *
 * The truth is the smooth walls alone: no roughness, no holes, no debris. In an image without
 * damage the isosurface at `IsoValue` lies on the true walls within about 0.1 voxels.
 *
 * The output is a function of the properties, bit for bit: the same for any number of threads,
 * and the same whether the image is made at once or in pieces (streaming, MPI).
 *
 * Output port 0, `vtkImageData` with its origin at the center of voxel (0, 0, 0):
 * - point array `CT` (UInt16): gray values, air 9000, wall 30000 by default, debris 0.55 to 1.2
 *   of the way from air to wall.
 *
 * Output port 1, `vtkPolyData`: the true walls as grids of quads about a voxel apart.
 * - point array `Side` (UInt8): 0 outer wall, 1 inner wall;
 * - point array `End` (Int32): 1 and 2 on the rims of the open ends, else 0.
 * Under MPI the first process has all of it.
 *
 * Field data of both: `IsoValue`, `Seed`, `Holes`, `Roughness`, `Noise`, `Blur`, `Collapse`,
 * `OpenEnds`, `MeanRadius`, `MeanThickness` (both in world units).
 *
 * "Voxels" are multiples of the smallest spacing.
 *
 * @warning The volume must be at least 24 voxels wide. A volume shorter than the fiber is wide, or
 * one that is far longer (200 times), is refused.
 * @warning Holes, pits and tunnels are drawn at random; they may overlap.
 *
 * @sa vtkFiberReconstruction vtkClosing vtkEDTClassify
 */
#ifndef vtkFiberPhantom_h
#define vtkFiberPhantom_h

#include "BSplineReconstructionFiltersModule.h" // For export macro
#include "vtkImageAlgorithm.h"

class BSPLINERECONSTRUCTIONFILTERS_EXPORT vtkFiberPhantom : public vtkImageAlgorithm
{
public:
  static vtkFiberPhantom* New();
  vtkTypeMacro(vtkFiberPhantom, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// Voxels along x (the fiber's direction), y and z: 24 to 8192. Default 192, 96, 96.
  vtkSetVector3Macro(Dimensions, int);
  vtkGetVector3Macro(Dimensions, int);
  ///@}
  ///@{
  /// Distance of the voxels' centers in world units. Default 1, 1, 1.
  vtkSetVector3Macro(Spacing, double);
  vtkGetVector3Macro(Spacing, double);
  ///@}
  ///@{
  /// Another seed, another fiber with other damage. Default 1.
  vtkSetMacro(Seed, int);
  vtkGetMacro(Seed, int);
  ///@}
  ///@{
  /// Cut the ends open (default), or close them by rounded caps of the wall's thickness.
  vtkSetMacro(OpenEnds, bool);
  vtkGetMacro(OpenEnds, bool);
  vtkBooleanMacro(OpenEnds, bool);
  ///@}
  ///@{
  /// Number of openings through the wall, 60 % round and 40 % slits. Default 8.
  vtkSetMacro(Holes, int);
  vtkGetMacro(Holes, int);
  ///@}
  ///@{
  /// Blind pits in the outer wall. -1 (default): two for each hole.
  vtkSetMacro(Pits, int);
  vtkGetMacro(Pits, int);
  ///@}
  ///@{
  /// Narrow crooked openings through the wall. -1 (default): eight for each hole.
  vtkSetMacro(Tunnels, int);
  vtkGetMacro(Tunnels, int);
  ///@}
  ///@{
  /// Voids enclosed in the wall. -1 (default): six for each hole.
  vtkSetMacro(Cavities, int);
  vtkGetMacro(Cavities, int);
  ///@}
  ///@{
  /// Pieces of debris, loose or adhering, inside or outside, and fibrils. Default 24.
  vtkSetMacro(Debris, int);
  vtkGetMacro(Debris, int);
  ///@}
  ///@{
  /// Root mean square height of the roughness of both walls in voxels, 0 to 5. Default 0.6.
  vtkSetMacro(Roughness, double);
  vtkGetMacro(Roughness, double);
  ///@}
  ///@{
  /// Standard deviation of the noise as a share of the contrast, 0 to 2. Default 0.1.
  vtkSetMacro(Noise, double);
  vtkGetMacro(Noise, double);
  ///@}
  ///@{
  /// Standard deviation of the ring artifacts as a share of the contrast, 0 to 1. Default 0.02.
  vtkSetMacro(Rings, double);
  vtkGetMacro(Rings, double);
  ///@}
  ///@{
  /// Loss of contrast on the scan's axis (beam hardening), 0 to 0.5. Default 0.05.
  vtkSetMacro(Shading, double);
  vtkGetMacro(Shading, double);
  ///@}
  ///@{
  /// Standard deviation of the Gaussian blur in voxels, 0 to 5. Default 0.8.
  vtkSetMacro(Blur, double);
  vtkGetMacro(Blur, double);
  ///@}
  ///@{
  /// How far the section has collapsed: 0 nearly round, 1 a flat kidney. Default 0.5.
  vtkSetMacro(Collapse, double);
  vtkGetMacro(Collapse, double);
  ///@}
  ///@{
  /// Bend of the centerline as a share of the room there is for it, 0 to 2. Default 1.
  vtkSetMacro(Bend, double);
  vtkGetMacro(Bend, double);
  ///@}
  ///@{
  /// Turns of the section over the fiber's length, -3 to 3. Default 0.5.
  vtkSetMacro(Twist, double);
  vtkGetMacro(Twist, double);
  ///@}
  ///@{
  /// Mean thickness of the wall as a share of the mean radius, 0.1 to 0.5. Default 0.28.
  vtkSetMacro(WallThickness, double);
  vtkGetMacro(WallThickness, double);
  ///@}
  ///@{
  /// Length of the fiber as a share of the volume's length, 0.3 to 1.5; above 1.1 it leaves the
  /// volume at both ends. Default 0.86.
  vtkSetMacro(Length, double);
  vtkGetMacro(Length, double);
  ///@}
  ///@{
  /// Gray values of air and wall within 0 to 65535. Default 9000 and 30000.
  vtkSetMacro(AirValue, double);
  vtkGetMacro(AirValue, double);
  vtkSetMacro(WallValue, double);
  vtkGetMacro(WallValue, double);
  ///@}

protected:
  vtkFiberPhantom();
  ~vtkFiberPhantom() override = default;

  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkFiberPhantom(const vtkFiberPhantom&) = delete;
  void operator=(const vtkFiberPhantom&) = delete;

  class Internals;

  int Dimensions[3] = {192, 96, 96};
  double Spacing[3] = {1.0, 1.0, 1.0};
  int Seed = 1;
  int Holes = 8;
  int Pits = -1;
  int Tunnels = -1;
  int Cavities = -1;
  int Debris = 24;
  double Roughness = 0.6;
  double Noise = 0.10;
  double Rings = 0.02;
  double Shading = 0.05;
  double Blur = 0.8;
  double Collapse = 0.5;
  double Bend = 1.0;
  double Twist = 0.5;
  double WallThickness = 0.28;
  double Length = 0.86;
  double AirValue = 9000.0;
  double WallValue = 30000.0;
  bool OpenEnds = true;
};

#endif
