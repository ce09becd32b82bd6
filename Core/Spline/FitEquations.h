#pragma once

#include "Spline/FitSystem.h"

namespace bsr
{
/**
 * (1 - lambda) K n / sum(w) E_LS + lambda E_TP: with n patches and points of total weight sum(w), K
 * is the number of points a patch that the data count as, whatever their real number, unit and
 * size. Patches may be faired more than others and pulled to a reference.
 */
struct FitEquations
{
  PatchBlocks Data;
  double TotalWeight = 0.0;
  PatchEnergies Energies;
  std::vector<std::array<double, 2>> Aspect; ///< of each patch, see thinPlate(a, b)
  std::vector<double> Stiffness;             ///< factor on the fairing of each patch
  std::vector<double> Pull;                  ///< strength of the pull to Reference, a patch
  NetPoints Reference;
  /// Fairing acts on the difference to this net, where given (empty: on the surface itself).
  NetPoints RestShape;

  PatchBlocks blocks(const PatchNet& net, double lambda, double dataWeight) const;
};
} // namespace bsr
