"""The friction laws of this package, and what finds them, for type checkers."""

from vibroimpact.contact.friction.law import FrictionLaw as FrictionLaw
from vibroimpact.contact.friction.laws.coulomb import Coulomb as Coulomb
from vibroimpact.contact.friction.laws.mdr import MDR as MDR
from vibroimpact.contact.friction.laws.mindlin import Mindlin as Mindlin
from vibroimpact.contact.friction.laws.mindlin import MindlinForce as MindlinForce
from vibroimpact.contact.friction.laws.mindlin import MindlinRescale as MindlinRescale
from vibroimpact.contact.friction.laws.rigid import Rigid as Rigid
from vibroimpact.contact.friction.registry import find_friction_law as find_friction_law
from vibroimpact.contact.friction.registry import friction_laws as friction_laws
