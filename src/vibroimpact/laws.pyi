"""The contact laws of this package, and what is done with laws, for type checkers."""

from vibroimpact.contact.law import ContactLaw as ContactLaw
from vibroimpact.contact.laws.adams_impact import AdamsImpact as AdamsImpact
from vibroimpact.contact.laws.adams_poisson import AdamsPoisson as AdamsPoisson
from vibroimpact.contact.laws.anagnostopoulos import Anagnostopoulos as Anagnostopoulos
from vibroimpact.contact.laws.flores import Flores as Flores
from vibroimpact.contact.laws.gonthier import Gonthier as Gonthier
from vibroimpact.contact.laws.herbert_mcwhannell import HerbertMcWhannell as HerbertMcWhannell
from vibroimpact.contact.laws.hertz import Hertz as Hertz
from vibroimpact.contact.laws.hu_guo import HuGuo as HuGuo
from vibroimpact.contact.laws.hunt_crossley import HuntCrossley as HuntCrossley
from vibroimpact.contact.laws.jackson_green_marghitu import (
    JacksonGreenMarghitu as JacksonGreenMarghitu,
)
from vibroimpact.contact.laws.jankowski import Jankowski as Jankowski
from vibroimpact.contact.laws.jkr import JKR as JKR
from vibroimpact.contact.laws.krijt import Krijt as Krijt
from vibroimpact.contact.laws.kuwabara_kono import KuwabaraKono as KuwabaraKono
from vibroimpact.contact.laws.lankarani_nikravesh import LankaraniNikravesh as LankaraniNikravesh
from vibroimpact.contact.laws.lee_wang import LeeWang as LeeWang
from vibroimpact.contact.laws.linear_spring_dashpot import (
    LinearSpringDashpot as LinearSpringDashpot,
)
from vibroimpact.contact.laws.meyer import Meyer as Meyer
from vibroimpact.contact.laws.newton import Newton as Newton
from vibroimpact.contact.laws.safaeifar import Safaeifar as Safaeifar
from vibroimpact.contact.laws.storakers import Storakers as Storakers
from vibroimpact.contact.laws.thornton import Thornton as Thornton
from vibroimpact.contact.laws.tsuji import Tsuji as Tsuji
from vibroimpact.contact.laws.walton_braun import WaltonBraun as WaltonBraun
from vibroimpact.contact.laws.zhiying_qishao import ZhiyingQishao as ZhiyingQishao
from vibroimpact.contact.quasi_static import QuasiStatic as QuasiStatic
from vibroimpact.contact.registry import contact_laws as contact_laws
from vibroimpact.contact.registry import find_contact_law as find_contact_law
from vibroimpact.contact.speed_function import SpeedFunction as SpeedFunction
from vibroimpact.contact.speed_function import SpeedTable as SpeedTable
from vibroimpact.dynamics.restitution import achieved_restitution as achieved_restitution
from vibroimpact.dynamics.restitution import integrated_restitution as integrated_restitution
from vibroimpact.dynamics.restitution import law_achieving as law_achieving
from vibroimpact.law_comparison.comparison import Comparison as Comparison
from vibroimpact.law_comparison.comparison import compare_laws as compare_laws
from vibroimpact.law_comparison.ranking import Ranking as Ranking
from vibroimpact.law_comparison.ranking import rank_laws as rank_laws
from vibroimpact.law_sheets.curves import law_chart as law_chart
